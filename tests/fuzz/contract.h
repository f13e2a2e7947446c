// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vantage/base/error.h"

/// What every reader promises: `read` of any bytes ends well, or throws vantage::Error for bad input in one line. Anything else ends the program.
template <class Read>
int keeps_contract(const std::uint8_t* data, std::size_t size, Read&& read) {
  try {
    read(std::string_view(reinterpret_cast<const char*>(data), size));
  } catch (const vantage::Error& error) {
    if (error.code() != vantage::ErrorCode::bad_input || std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}

inline void demand(bool holds) {
  if (!holds) std::abort();
}

/// libFuzzer's own changes, for mutators that mend checksums after them.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
