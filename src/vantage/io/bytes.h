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

/// Puts `value` in the place of the bytes at `offset`, which the caller has checked to lie inside.
template <class Number>
void overwrite(std::string& bytes, std::size_t offset, Number value) {
  std::string number;
  put(number, value);
  bytes.replace(offset, sizeof(Number), number);
}

/// The number at `offset`, which the caller has checked to lie inside `bytes`.
template <class Number>
[[nodiscard]] Number get(std::string_view bytes, std::size_t offset, std::endian order = std::endian::little) {
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof(Number));
  return order == std::endian::native ? value : byte_swapped(value);
}

/// a * b. Throws bad_input, naming both and `where`, when that does not fit.
[[nodiscard]] std::size_t checked_product(std::uint64_t a, std::uint64_t b, std::string_view where);

/// The bytes of a file with its name: whatever is read is checked to be there, else bad_input naming `FILE:OFFSET`.
class FileBytes {
 public:
  FileBytes(std::string_view bytes, std::string_view where) : bytes_(bytes), where_(where) {}
  [[nodiscard]] std::uint64_t size() const { return bytes_.size(); }
  [[nodiscard]] std::string_view where() const { return where_; }
  [[nodiscard]] std::string_view all() const { return bytes_; }
  /// `length` bytes from `offset`; `what` names them when the file is too short.
  [[nodiscard]] std::string_view part(std::uint64_t offset, std::uint64_t length, std::string_view what) const {
    if (offset > bytes_.size() || length > bytes_.size() - offset) fail_short(offset, length, what);
    return bytes_.substr(offset, length);
  }
  template <class Number>
  [[nodiscard]] Number number(std::uint64_t offset, std::string_view what) const {
    return get<Number>(part(offset, sizeof(Number), what), 0);
  }
  [[noreturn]] void fail(std::uint64_t offset, const std::string& message) const;

 private:
  [[noreturn]] void fail_short(std::uint64_t offset, std::uint64_t length, std::string_view what) const;
  std::string_view bytes_, where_;
};

}  // namespace vantage
