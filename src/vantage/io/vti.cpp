// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/vti.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <pugixml.hpp>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/bytes.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

constexpr std::size_t kBlockBytes = 1 << 20;
constexpr int kCompressionLevel = 3;
constexpr double kMostNodes = 2147483647.0;  // Along an axis, counted from node 0.

std::string deflated(std::string_view block) {
  uLongf size = compressBound(block.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(block.data()), block.size(), kCompressionLevel) != Z_OK)
    throw Error(ErrorCode::memory, "zlib cannot compress a block");
  out.resize(size);
  return out;
}

/// [blocks] [bytes a block] [bytes of a shorter last block, else 0] [compressed bytes of each], then the blocks.
std::string compressed_array(std::string_view bytes) {
  const std::size_t count = (bytes.size() + kBlockBytes - 1) / kBlockBytes;
  std::vector<std::string> blocks(count);
  parallel_for(count, 1, [&](std::size_t i) { blocks[i] = deflated(bytes.substr(i * kBlockBytes, kBlockBytes)); });
  std::string out;
  put<std::uint64_t>(out, count);
  put<std::uint64_t>(out, kBlockBytes);
  put<std::uint64_t>(out, bytes.size() % kBlockBytes);
  for (const std::string& block : blocks) put<std::uint64_t>(out, block.size());
  for (const std::string& block : blocks) out += block;
  return out;
}

std::string_view bytes_of(const ImageArray& array) {
  return std::visit([](const auto& v) { return std::string_view(reinterpret_cast<const char*>(v.data()), v.size_bytes()); }, array.values);
}

std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) numbers.push_back(to_number<double>(word).value_or(0.0));
  return numbers;
}

}  // namespace

template <int Dim>
std::string image_as_vti(const Grid<Dim>& window, std::span<const ImageArray> arrays) {
  static_assert(std::endian::native == std::endian::little, "the arrays are written as they lie in memory");
  double origin[3] = {0.0, 0.0, 0.0};
  std::int32_t last[3] = {0, 0, 0};
  const Vec<Dim> low = window.position(Index<Dim>(Index<Dim>::Zero()));
  for (int a = 0; a < Dim; ++a) {
    origin[a] = low[a];
    last[a] = window.extent[a] - 1;
  }
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", last[0], last[1], last[2]);
  std::string head =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">\n";
  head += fmt::format(
      "  <ImageData WholeExtent=\"{0}\" Origin=\"{1} {2} {3}\" Spacing=\"{4} {4} {4}\">\n    <Piece Extent=\"{0}\">\n      <PointData "
      "Scalars=\"{5}\">\n",
      extent, origin[0], origin[1], origin[2], window.spacing, arrays.empty() ? "" : arrays.front().name);
  std::string data;
  for (const ImageArray& array : arrays) {
    const char* type = array.values.index() == 0 ? "UInt8" : "Float32";
    head += fmt::format("        <DataArray type=\"{}\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type, array.name, data.size());
    data += compressed_array(bytes_of(array));
  }
  head += "      </PointData>\n      <CellData/>\n    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"raw\">\n   _";
  return head + data + "\n  </AppendedData>\n</VTKFile>\n";
}

ImageInfo parse_vti_header(std::string_view bytes, std::string_view where) {
  const std::size_t end = bytes.find("<AppendedData");
  const std::string text = std::string(bytes.substr(0, end)) + (end == std::string_view::npos ? "" : "</VTKFile>");
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  require(result, fmt::format("not a VTK image: {}", result.description()), fmt::format("{}:{}", where, result.offset));
  const pugi::xml_node image = document.child("VTKFile").child("ImageData");
  const std::vector<double> extent = numbers_of(image.attribute("WholeExtent").value());
  require(image && extent.size() == 6, "not a VTK image: no ImageData with a WholeExtent", where);
  ImageInfo info;
  for (const double last : extent)
    require(std::abs(last) <= kMostNodes, fmt::format("WholeExtent {}: must be within +-{}", fmt::join(extent, " "), kMostNodes), where);
  for (std::size_t a = 0; a < 3; ++a) info.nodes.push_back(static_cast<std::int64_t>(extent[2 * a + 1] - extent[2 * a]) + 1);
  info.origin = numbers_of(image.attribute("Origin").value());
  info.spacing = numbers_of(image.attribute("Spacing").value());
  // The origin is node 0's, the image begins where the extent does.
  for (std::size_t a = 0; a < std::min(info.origin.size(), info.spacing.size()) && a < 3; ++a) info.origin[a] += info.spacing[a] * extent[2 * a];
  for (const pugi::xml_node& array : image.child("Piece").child("PointData").children("DataArray"))
    info.arrays.push_back({array.attribute("Name").value(), array.attribute("type").value()});
  return info;
}

template std::string image_as_vti<2>(const Grid<2>&, std::span<const ImageArray>);
template std::string image_as_vti<3>(const Grid<3>&, std::span<const ImageArray>);

}  // namespace vantage
