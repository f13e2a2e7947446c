// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/point_cloud_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/ply_file.h"
#include "vantage/io/point_cloud_formats.h"
#include "vantage/io/records.h"
#include "vantage/io/scan_file.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

constexpr std::string_view kPlaneComment = "dim 2";
constexpr double kFloatReach = 4096.0;  // Up to here [m] a float is good to a quarter of a millimetre.

NumberType number_type(Ply::Type type) {
  constexpr NumberType kTypes[] = {NumberType::int8,  NumberType::uint8,  NumberType::int16,   NumberType::uint16,
                                   NumberType::int32, NumberType::uint32, NumberType::float32, NumberType::float64};
  return kTypes[static_cast<int>(type)];
}

/// Bytes of an element's record; none: with a list they differ.
std::optional<std::size_t> record_bytes(const Ply::Element& element) {
  std::size_t bytes = 0;
  for (const Ply::Property& property : element.properties) {
    if (property.count_type) return std::nullopt;
    bytes += size_of(number_type(property.type));
  }
  return bytes;
}

const Ply::Element& vertices(const Ply& ply, std::string_view where) {
  const Ply::Element* vertex = ply.find("vertex");
  require(vertex != nullptr, "no vertex element", where);
  const Ply::Property *x = vertex->find("x"), *y = vertex->find("y"), *z = vertex->find("z");
  require(x != nullptr && y != nullptr && !x->count_type && !y->count_type && !(z != nullptr && z->count_type), "vertices without x and y", where);
  return *vertex;
}

/// The points of a binary file whose records up to the vertices have fixed sizes; none: it is no such file.
std::optional<std::vector<Vec<3>>> fixed_records(const Ply& ply, std::string_view data, std::string_view where) {
  if (ply.format == "ascii") return std::nullopt;
  std::uint64_t begin = 0;
  for (const Ply::Element& element : ply.elements) {
    const std::optional<std::size_t> stride = record_bytes(element);
    if (!stride) return std::nullopt;
    if (element.name != "vertex") {
      begin += checked_product(element.count, *stride, where);
      require(begin <= data.size(),
              fmt::format("{} {} elements exceed the file ({} bytes of data)", element.count, printable(element.name), data.size()), where);
      continue;
    }
    PointColumns columns;
    std::size_t offset = 0;
    for (const Ply::Property& property : element.properties) {
      for (std::size_t a = 0; a < 3; ++a)
        if (property.name == std::string_view("xyz").substr(a, 1) && !columns[a])
          columns[a] = NumberColumn{offset, *stride, number_type(property.type)};
      offset += size_of(number_type(property.type));
    }
    return widen_points(data.substr(begin), element.count, columns, where,
                        ply.format == "binary_big_endian" ? std::endian::big : std::endian::little);
  }
  return std::nullopt;
}

std::vector<Vec<3>> points_of_columns(std::string_view bytes, std::string_view where) {
  const auto wanted = [](std::string_view element, std::string_view p) { return element == "vertex" && (p == "x" || p == "y" || p == "z"); };
  const Ply ply = parse_ply_columns(bytes, where, wanted);
  const Ply::Element& vertex = vertices(ply, where);
  const Ply::Property *x = vertex.find("x"), *y = vertex.find("y"), *z = vertex.find("z");
  std::vector<Vec<3>> points;
  points.reserve(vertex.count);
  for (std::size_t i = 0; i < vertex.count; ++i) points.emplace_back(x->values[i], y->values[i], z == nullptr ? 0.0 : z->values[i]);
  return points;
}

/// Of a format that has scans: their points, one scan after the other.
PointCloud joined(std::vector<MeasuredScan> scans, std::string_view format) {
  PointCloud cloud;
  cloud.format = scans.empty() ? std::string(format) : scans.front().format;
  for (MeasuredScan& scan : scans) {
    cloud.not_finite += scan.not_finite;
    if (cloud.points.empty())
      cloud.points = std::move(scan.points);
    else
      cloud.points.insert(cloud.points.end(), scan.points.begin(), scan.points.end());
  }
  return cloud;
}

template <class Number, int Dim>
std::string coordinates(std::span<const Vec<Dim>> points) {
  std::string out;
  out.reserve(points.size() * 3 * sizeof(Number));
  for (const Vec<Dim>& p : points)
    for (int a = 0; a < 3; ++a) put(out, a < Dim ? static_cast<Number>(p[a]) : Number(0));
  return out;
}

}  // namespace

PointCloud parse_ply_points(std::string_view bytes, std::string_view where) {
  std::size_t offset = 0;
  const Ply ply = parse_ply_header(bytes, where, offset);
  const Ply::Element& vertex = vertices(ply, where);
  PointCloud cloud;
  cloud.format = "PLY, " + ply.format;
  const bool plane = std::find(ply.comments.begin(), ply.comments.end(), kPlaneComment) != ply.comments.end();
  cloud.dim = plane || vertex.find("z") == nullptr ? 2 : 3;
  std::optional<std::vector<Vec<3>>> points = fixed_records(ply, bytes.substr(offset), where);
  cloud.points = points ? std::move(*points) : points_of_columns(bytes, where);
  return cloud;
}

PointCloud parse_points(std::string_view bytes, std::string_view where) {
  require(!bytes.empty(), "the file is empty", where);
  const std::optional<std::string_view> format = scan_format(bytes, where);
  if (format && *format != "PLY" && *format != "PCD" && *format != "text") return joined(parse_scan_file(bytes, where), *format);
  PointCloud cloud = format == "PLY" ? parse_ply_points(bytes, where) : format == "PCD" ? parse_pcd(bytes, where) : parse_xyz(bytes, where);
  cloud.not_finite = std::count_if(cloud.points.begin(), cloud.points.end(), [](const Vec<3>& p) { return !p.allFinite(); });
  return cloud;
}

PointCloud read_points(const std::filesystem::path& path) { return parse_points(read_buffer(path).view(), path.string()); }

template <int Dim>
std::string points_as_ply(std::span<const Vec<Dim>> points) {
  double reach = 0.0;
  for (const Vec<Dim>& p : points) reach = std::max(reach, p.cwiseAbs().maxCoeff());
  const bool wide = !(reach < kFloatReach);
  const std::string_view type = wide ? "double" : "float";
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\ncomment dim {0}\nelement vertex {1}\nproperty {2} x\nproperty {2} y\nproperty {2} "
             "z\nend_header\n",
             Dim, points.size(), type) +
         (wide ? coordinates<double>(points) : coordinates<float>(points));
}

template <int Dim>
std::string points_as_xyz(std::span<const Vec<Dim>> points) {
  std::string out;
  for (const Vec<Dim>& p : points) fmt::format_to(std::back_inserter(out), "{}\n", fmt::join(p.data(), p.data() + Dim, " "));
  return out;
}

template std::string points_as_ply<2>(std::span<const Vec<2>>);
template std::string points_as_ply<3>(std::span<const Vec<3>>);
template std::string points_as_xyz<2>(std::span<const Vec<2>>);
template std::string points_as_xyz<3>(std::span<const Vec<3>>);

}  // namespace vantage
