// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/npy.h"

#include <fmt/format.h>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

constexpr std::string_view kMagic{"\x93NUMPY", 6};
constexpr std::size_t kAlignment = 64;  // Of the data, as NumPy has it.

/// The value of a key in the header's dictionary; empty: not there.
std::string_view value_of(std::string_view header, std::string_view key, std::string_view end) {
  const std::size_t begin = header.find(key);
  if (begin == std::string_view::npos) return {};
  const std::string_view rest = header.substr(begin + key.size());
  const std::size_t stop = rest.find(end);
  return stop == std::string_view::npos ? std::string_view{} : rest.substr(0, stop + (end == ")" ? 1 : 0));
}

}  // namespace

std::string array_as_npy(const LatticeArray& array, std::span<const std::int64_t> nodes) {
  std::size_t count = 1;
  for (const std::int64_t n : nodes) count *= static_cast<std::size_t>(n);
  const std::size_t size = std::visit([](const auto& values) { return values.size(); }, array.values);
  require(size == count, fmt::format("array {}: {} values for {} nodes", array.name, size, count));
  const bool bytes = array.values.index() == 0;
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': True, 'shape': ({}{}), }}", bytes ? "|u1" : "<f4", fmt::join(nodes, ", "),
                                   nodes.size() == 1 ? "," : "");
  const std::size_t unpadded = kMagic.size() + 4 + header.size() + 1;
  header.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string out(kMagic);
  put<std::uint8_t>(out, 1);
  put<std::uint8_t>(out, 0);
  put(out, static_cast<std::uint16_t>(header.size()));
  out += header;
  out.reserve(out.size() + count * (bytes ? 1 : 4));
  std::visit(
      [&](const auto& values) {
        for (const auto value : values) put(out, value);
      },
      array.values);
  return out;
}

std::string describe_npy(std::string_view bytes, std::string_view where) {
  require(bytes.starts_with(kMagic) && bytes.size() >= 12, "not a NumPy file (.npy)", where);
  const bool first = bytes[6] == 1;
  const std::size_t begin = first ? 10 : 12;
  const std::size_t length = first ? get<std::uint16_t>(bytes, 8) : get<std::uint32_t>(bytes, 8);
  require(length <= bytes.size() - begin, fmt::format("header of {} bytes exceeds the file", length), where);
  const std::string_view header = bytes.substr(begin, length);
  const std::string_view type = value_of(header, "'descr': ", ","), shape = value_of(header, "'shape': ", ")");
  require(!type.empty() && !shape.empty(), "NumPy header without descr and shape", where);
  return fmt::format("{}, {}", printable(type), printable(shape));
}

}  // namespace vantage
