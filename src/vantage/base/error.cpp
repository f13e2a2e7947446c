// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

namespace vantage {
namespace {

double available_bytes() {
  std::ifstream meminfo("/proc/meminfo");
  std::string key, unit;
  double kibibytes = 0.0;
  while (meminfo >> key >> kibibytes) {
    if (key == "MemAvailable:") return kibibytes * 1024.0;
    std::getline(meminfo, unit);
  }
  return 1e18;  // Unknown: let the allocation itself decide.
}

/// One line, whatever a file or its name holds: control characters become `?`.
std::string one_line(std::string text) {
  std::replace_if(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

}  // namespace

Error::Error(ErrorCode code, const std::string& message, std::string where)
    : std::runtime_error(one_line(where.empty() ? message : where + ": " + message)), code_(code), where_(std::move(where)) {}

void require(bool condition, std::string_view message, std::string_view where) {
  if (!condition) throw Error(ErrorCode::bad_input, std::string(message), std::string(where));
}

void require_memory(double count, double bytes_each, std::string_view what) {
  constexpr double kGiB = 1024.0 * 1024.0 * 1024.0, kAlways = 1 << 20;  // So little is not worth asking the system for.
  const double need = count * bytes_each;
  if (need < kAlways) return;
  const double have = available_bytes();
  if (need > have) throw Error(ErrorCode::memory, fmt::format("{}: needs {:.1f} GiB, {:.1f} GiB are free", what, need / kGiB, have / kGiB));
}

}  // namespace vantage
