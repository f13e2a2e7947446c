// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <pugixml.hpp>

#include "vantage/base/error.h"
#include "vantage/io/bytes.h"
#include "vantage/io/text.h"
#include "vantage/io/vti.h"

namespace vantage {
namespace {

constexpr std::uint64_t kMostPerByte = 1040;  // A byte of deflated data stands for fewer.
constexpr double kMostNodes = 1 << 30;        // Along an axis.
constexpr double kOffLattice = 1e-6;          // Of a spacing, that an origin may be off.

/// An appended array's blocks: their number, bytes of each, of a shorter last one (else 0), compressed bytes of each, then the blocks.
class Blocks {
 public:
  Blocks(const FileBytes& file, std::uint64_t begin, std::string name) : file_(file), begin_(begin), name_(std::move(name)) {}

  /// All of `bytes` bytes, as the lattice wants them.
  [[nodiscard]] std::string read(std::uint64_t bytes) const {
    const std::uint64_t count = word(0), block = word(1), last = word(2);
    // Of a file that is there, so that nothing below overflows.
    (void)file_.part(begin_ + 24, checked_product(count, 8, file_.where()), name_);
    check(block > 0 && last < block && count == bytes / block + (bytes % block != 0) && bytes % block == last,
          fmt::format("{} blocks of {} bytes do not hold {} bytes", count, block, bytes));
    std::string out;
    std::uint64_t at = begin_ + 24 + 8 * count;
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::string_view packed = file_.part(at, word(3 + k), name_);
      inflate(packed, std::min(block, bytes - out.size()), out);
      at += packed.size();
    }
    return out;
  }

 private:
  [[nodiscard]] std::uint64_t word(std::uint64_t k) const { return file_.number<std::uint64_t>(begin_ + 8 * k, name_); }
  void check(bool holds, const std::string& message) const {
    if (!holds) file_.fail(begin_, fmt::format("{}: {}", name_, message));
  }
  void inflate(std::string_view packed, std::uint64_t want, std::string& out) const {
    check(want <= kMostPerByte * packed.size(), fmt::format("{} compressed bytes cannot give {}", packed.size(), want));
    const std::size_t begin = out.size();
    out.resize(begin + want);
    uLongf size = want;
    const int result = uncompress(reinterpret_cast<Bytef*>(out.data() + begin), &size, reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    check(result == Z_OK && size == want, "the compressed data is damaged");
  }

  FileBytes file_;
  std::uint64_t begin_;
  std::string name_;
};

Grid<3> window_of(const ImageInfo& info, std::string_view where) {
  require(info.origin.size() == 3 && info.spacing.size() == 3, "Origin and Spacing: must be three numbers", where);
  const double h = info.spacing[0];
  require(h > 0.0 && std::isfinite(h) && info.spacing[1] == h && info.spacing[2] == h,
          fmt::format("Spacing {}: must be one number > 0 along all axes", fmt::join(info.spacing, " ")), where);
  Grid<3> window;
  window.spacing = h;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const double first = info.origin[axis] / h, nodes = static_cast<double>(info.nodes[axis]);
    require(nodes >= 1.0 && nodes <= kMostNodes, fmt::format("{} nodes along an axis: must be 1 .. {}", nodes, kMostNodes), where);
    require(std::abs(first) <= kMostNodes && std::abs(first - std::round(first)) <= kOffLattice * std::max(1.0, std::abs(first)),
            fmt::format("Origin {}: must be multiples of the spacing, {}", fmt::join(info.origin, " "), h), where);
    window.first[a] = static_cast<std::int32_t>(std::round(first));
    window.extent[a] = static_cast<std::int32_t>(nodes);
  }
  return window;
}

template <class Value>
std::vector<Value> values_of(const std::string& bytes) {
  std::vector<Value> values;
  values.reserve(bytes.size() / sizeof(Value));
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Value)) values.push_back(get<Value>(bytes, at));
  return values;
}

LatticeArray read_array(const FileBytes& file, const pugi::xml_node& node, std::uint64_t data, std::uint64_t nodes) {
  LatticeArray array{node.attribute("Name").value(), {}};
  const std::string_view type = node.attribute("type").value();
  require((type == "UInt8" || type == "Float32") && std::string_view(node.attribute("format").value()) == "appended",
          fmt::format("array {}, {} {}: only UInt8 and Float32, appended, are read", printable(array.name), printable(type),
                      printable(node.attribute("format").value())),
          file.where());
  const std::uint64_t offset = node.attribute("offset").as_ullong();
  if (offset > file.size()) file.fail(data, fmt::format("array {}: offset {} exceeds the file", printable(array.name), offset));
  const bool small = type == "UInt8";
  const std::string bytes = Blocks(file, data + offset, "array " + printable(array.name)).read(checked_product(nodes, small ? 1 : 4, file.where()));
  if (small)
    array.values = values_of<std::uint8_t>(bytes);
  else
    array.values = values_of<float>(bytes);
  return array;
}

}  // namespace

LatticeImage parse_vti(std::string_view bytes, std::string_view where) {
  LatticeImage image{window_of(parse_vti_header(bytes, where), where), {}};
  const std::size_t appended = bytes.find("<AppendedData");
  require(appended != std::string_view::npos, "no AppendedData: only vantage's own encoding is read (appended, raw, zlib)", where);
  pugi::xml_document document;
  const std::string head = std::string(bytes.substr(0, appended)) + "</VTKFile>";
  document.load_buffer(head.data(), head.size());
  const pugi::xml_node root = document.child("VTKFile");
  const auto says = [&](const char* attribute, std::string_view wanted) {
    require(std::string_view(root.attribute(attribute).value()) == wanted,
            fmt::format("{}=\"{}\": must be {}", attribute, printable(root.attribute(attribute).value()), wanted), where);
  };
  says("byte_order", "LittleEndian");
  says("header_type", "UInt64");
  says("compressor", "vtkZLibDataCompressor");
  const std::size_t underscore = bytes.find('_', bytes.find('>', appended));
  require(bytes.substr(appended, 64).find("encoding=\"raw\"") != std::string_view::npos && underscore != std::string_view::npos,
          "AppendedData: must be encoded raw", where);
  const auto nodes = checked_product(checked_product(image.window.extent[0], image.window.extent[1], where), image.window.extent[2], where);
  for (const pugi::xml_node& node : root.child("ImageData").child("Piece").child("PointData").children("DataArray"))
    image.arrays.push_back(read_array(FileBytes(bytes, where), node, underscore + 1, nodes));
  return image;
}

}  // namespace vantage
