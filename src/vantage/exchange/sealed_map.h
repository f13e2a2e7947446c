// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

#include "vantage/io/bytes.h"

namespace vantage::samples {

/// A changed map of the same size with the checksums of its header and deltas made right again, for tests of what lies behind them.
inline std::string resealed_map(std::string_view changed) {
  constexpr std::size_t kHeader = 16, kNumber = 4;
  std::string file(changed);
  const auto set = [&](std::size_t at, std::uint32_t value) { overwrite(file, at, value); };
  if (file.size() < kHeader) return file;
  set(kHeader - kNumber, checksum(changed.substr(0, kHeader - kNumber)));
  for (std::size_t at = kHeader; file.size() - at >= 2 * kNumber;) {
    const std::size_t most = file.size() - at - 2 * kNumber, size = std::min<std::size_t>(get<std::uint32_t>(file, at), most);
    set(at, static_cast<std::uint32_t>(size));
    set(at + kNumber + size, checksum(std::string_view(file).substr(at, kNumber + size)));
    at += 2 * kNumber + size;
  }
  return file;
}

}  // namespace vantage::samples
