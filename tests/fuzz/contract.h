// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "vantage/base/error.h"

/// Ends the program, which is a finding, unless `holds`.
inline void demand(bool holds) {
  if (!holds) std::abort();
}

/// Processor time of inputs: the clock on the wall would blame a reader for what else the machine does. The most is printed at the end [ms],
/// and that of all [s].
class Stopwatch {
 public:
  ~Stopwatch() {
    std::fprintf(stderr, "stat::slowest_unit_cpu_ms: %.1f\nstat::cpu_seconds: %ld\n", 1e3 * static_cast<double>(most_) / CLOCKS_PER_SEC,
                 static_cast<long>(std::clock() / CLOCKS_PER_SEC) + 1);
  }
  void start() { begin_ = std::clock(); }
  void stop() {
    most_ = std::max(most_, std::clock() - begin_);
    demand(most_ <= CLOCKS_PER_SEC);  // One second.
  }

 private:
  std::clock_t begin_ = 0, most_ = 0;
};

/// What every reader promises: `read` of any bytes ends well within a second, or throws vantage::Error for bad input in one line.
template <class Read>
int keeps_contract(const std::uint8_t* data, std::size_t size, Read&& read) {
  static Stopwatch watch;
  watch.start();
  try {
    read(std::string_view(reinterpret_cast<const char*>(data), size));
  } catch (const vantage::Error& error) {
    if (error.code() != vantage::ErrorCode::bad_input || std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  watch.stop();
  return 0;
}

/// libFuzzer's own changes, for mutators that mend checksums after them.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
