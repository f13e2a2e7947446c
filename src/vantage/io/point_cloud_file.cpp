// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/point_cloud_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/ply_file.h"
#include "vantage/io/point_cloud_formats.h"

namespace vantage {
namespace {

constexpr std::string_view kPlaneComment = "dim 2";
constexpr double kFloatReach = 4096.0;  // Up to here [m] a float is good to a quarter of a millimetre.

PointCloud parse_ply_points(std::string_view bytes, std::string_view where) {
  const auto wanted = [](std::string_view element, std::string_view p) { return element == "vertex" && (p == "x" || p == "y" || p == "z"); };
  const Ply ply = parse_ply(bytes, where, wanted);
  const Ply::Element* vertex = ply.find("vertex");
  require(vertex != nullptr, "no vertex element", where);
  const Ply::Property *x = vertex->find("x"), *y = vertex->find("y"), *z = vertex->find("z");
  require(x != nullptr && y != nullptr && !x->count_type && !y->count_type && !(z != nullptr && z->count_type), "vertices without x and y", where);
  PointCloud cloud;
  cloud.format = "PLY, " + ply.format;
  const bool plane = std::find(ply.comments.begin(), ply.comments.end(), kPlaneComment) != ply.comments.end();
  cloud.dim = plane || z == nullptr ? 2 : 3;
  cloud.points.reserve(vertex->count);
  for (std::size_t i = 0; i < vertex->count; ++i) cloud.points.emplace_back(x->values[i], y->values[i], z == nullptr ? 0.0 : z->values[i]);
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

PointCloud parse_points(std::string_view bytes, std::string_view where) {
  require(!bytes.empty(), "the file is empty", where);
  PointCloud cloud;
  if (bytes.substr(0, 3) == "ply")
    cloud = parse_ply_points(bytes, where);
  else if (where.ends_with(".pcd") || bytes.starts_with("# .PCD"))
    cloud = parse_pcd(bytes, where);
  else
    cloud = parse_xyz(bytes, where);
  cloud.not_finite = std::count_if(cloud.points.begin(), cloud.points.end(), [](const Vec<3>& p) { return !p.allFinite(); });
  return cloud;
}

PointCloud read_points(const std::filesystem::path& path) { return parse_points(read_file(path), path.string()); }

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
