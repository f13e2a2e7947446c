// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace vantage {

/// CRC-32 (that of zlib and PNG); `start` continues an earlier one.
[[nodiscard]] std::uint32_t checksum(std::string_view bytes, std::uint32_t start = 0);

/// `value` with its bytes in the other order.
template <class Number>
[[nodiscard]] Number byte_swapped(Number value) {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &value, sizeof(Number));
  for (std::size_t i = 0; i < sizeof(Number) / 2; ++i) std::swap(bytes[i], bytes[sizeof(Number) - 1 - i]);
  std::memcpy(&value, bytes, sizeof(Number));
  return value;
}

/// Appends `value`, lowest byte first.
template <class Number>
void put(std::string& out, Number value) {
  if constexpr (std::endian::native == std::endian::big) value = byte_swapped(value);
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &value, sizeof(Number));
  out.append(bytes, sizeof(Number));
}

/// The number at `offset`, which the caller has checked to lie inside `bytes`.
template <class Number>
[[nodiscard]] Number get(std::string_view bytes, std::size_t offset, std::endian order = std::endian::little) {
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof(Number));
  return order == std::endian::native ? value : byte_swapped(value);
}

}  // namespace vantage
