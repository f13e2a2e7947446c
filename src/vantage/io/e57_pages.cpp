// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "vantage/io/e57.h"

namespace vantage {
namespace {

constexpr std::uint64_t kPage = 1024, kContent = kPage - 4, kHeader = 48;
constexpr std::uint32_t kPolynomial = 0x82f63b78;

using Table = std::array<std::array<std::uint32_t, 256>, 8>;

/// table[k][b]: the remainder of byte b followed by k zero bytes.
constexpr Table make_table() {
  Table table{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t c = b;
    for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1) ? kPolynomial : 0);
    table[0][b] = c;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t b = 0; b < 256; ++b) table[k][b] = (table[k - 1][b] >> 8) ^ table[0][table[k - 1][b] & 255];
  return table;
}

constexpr Table kTable = make_table();

std::uint32_t eight_bytes(std::uint32_t crc, std::uint64_t block) {
  block ^= crc;
  std::uint32_t out = 0;
  for (std::size_t k = 0; k < 8; ++k) out ^= kTable[7 - k][(block >> (8 * k)) & 255];
  return out;
}

}  // namespace

std::uint32_t checksum_castagnoli(std::string_view bytes) {
  std::uint32_t crc = ~std::uint32_t{0};
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) crc = eight_bytes(crc, get<std::uint64_t>(bytes, i));
  for (; i < bytes.size(); ++i) crc = (crc >> 8) ^ kTable[0][(crc ^ static_cast<std::uint8_t>(bytes[i])) & 255];
  return ~crc;
}

E57Pages::E57Pages(FileBytes file) : where_(file.where()) {
  const auto major = file.number<std::uint32_t>(8, "the header");
  const auto length = file.number<std::uint64_t>(16, "the header"), page = file.number<std::uint64_t>(40, "the header");
  if (major != 1) file.fail(8, fmt::format("E57 version {}: must be 1", major));
  if (page != kPage) file.fail(40, fmt::format("pages of {} bytes: must be {}", page, kPage));
  if (length < kPage || length % kPage != 0) file.fail(16, fmt::format("length {}: must be whole pages of {} bytes", length, kPage));
  const std::string_view pages = file.part(0, length, "the pages");
  contents_.reserve(length / kPage * kContent);
  for (std::uint64_t begin = 0; begin < length; begin += kPage) {
    const std::string_view content = pages.substr(begin, kContent);
    // The checksum alone is stored highest byte first.
    if (get<std::uint32_t>(pages, begin + kContent, std::endian::big) != checksum_castagnoli(content))
      file.fail(begin, "the page's checksum does not match: the file is damaged");
    contents_ += content;
  }
}

std::uint64_t E57Pages::logical(std::uint64_t physical, std::string_view what) const {
  const std::uint64_t within = physical % kPage;
  if (physical < kHeader || within >= kContent || physical / kPage * kContent + within > contents_.size())
    contents().fail(physical, fmt::format("{} does not begin within the file's pages", what));
  return physical / kPage * kContent + within;
}

std::string_view E57Pages::xml() const {
  const FileBytes bytes = contents();
  const auto begin = bytes.number<std::uint64_t>(24, "the header"), length = bytes.number<std::uint64_t>(32, "the header");
  return bytes.part(logical(begin, "the XML part"), length, "the XML part");
}

}  // namespace vantage
