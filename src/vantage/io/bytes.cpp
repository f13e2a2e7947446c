// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/bytes.h"

#include <fmt/format.h>
#include <zlib.h>

#include <limits>

#include "vantage/base/error.h"

namespace vantage {

std::uint32_t checksum(std::string_view bytes, std::uint32_t start) {
  return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::size_t checked_product(std::uint64_t a, std::uint64_t b, std::string_view where) {
  if (b != 0 && a > std::numeric_limits<std::size_t>::max() / b)
    throw Error(ErrorCode::bad_input, fmt::format("{} times {} is too large", a, b), std::string(where));
  return a * b;
}

void FileBytes::fail(std::uint64_t offset, const std::string& message) const {
  throw Error(ErrorCode::bad_input, message, fmt::format("{}:{}", where_, offset));
}

void FileBytes::fail_short(std::uint64_t offset, std::uint64_t length, std::string_view what) const {
  fail(offset, fmt::format("{} ({} bytes) exceed the file, which has {} bytes", what, length, bytes_.size()));
}

}  // namespace vantage
