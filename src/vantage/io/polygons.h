// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/geometry/mesh.h"

namespace vantage {

/// What a mesh file says, unchecked: polygons over vertices. Every format reads into this; `triangles` checks.
struct Polygons {
  std::vector<Vec<3>> vertices;
  std::vector<std::int64_t> corners;  ///< Of all polygons in turn, indices into `vertices`.
  std::vector<std::size_t> ends;      ///< Where each polygon ends in `corners`.
  std::vector<std::size_t> holes;     ///< Where inner rings begin in `corners`, ascending: of the polygon they lie in, behind its outline.

  void close_polygon() { ends.push_back(corners.size()); }
};

/// Equal vertices joined, polygons cut into triangles, unused vertices left out. Throws bad_input at `name` as read_mesh says.
[[nodiscard]] Mesh<3> triangles(const Polygons& polygons, const std::string& name);

/// Parsers of whole files; `name` stands in their errors.
[[nodiscard]] Polygons parse_obj(std::string_view bytes, const std::string& name);
[[nodiscard]] Polygons parse_off(std::string_view bytes, const std::string& name);
[[nodiscard]] Polygons parse_ply(std::string_view bytes, const std::string& name);
[[nodiscard]] Polygons parse_stl(std::string_view bytes, const std::string& name);

/// A scene with nodes, their transforms applied.
struct SceneGraph {
  Polygons polygons;
  char up = 'y';      ///< Axis that points up: x, y or z.
  double unit = 1.0;  ///< [m]
};
[[nodiscard]] SceneGraph parse_collada(std::string_view bytes, const std::string& name);
/// `name` is the path, beside which buffers may lie.
[[nodiscard]] SceneGraph parse_gltf(std::string_view bytes, const std::string& name);
/// CityJSON 1.0, 1.1, 2.0 and CityGML 1.0 .. 3.0: of each object the surfaces of its highest level of detail not above `detail`, or of its lowest;
/// < 0: of its highest. A building whose parts are shown in more detail is left to them.
[[nodiscard]] SceneGraph parse_cityjson(std::string_view bytes, const std::string& name, double detail);
[[nodiscard]] SceneGraph parse_citygml(std::string_view bytes, const std::string& name, double detail);
/// The level that they show, of those that there are (not empty).
[[nodiscard]] double chosen_detail(std::span<const double> present, double detail);

}  // namespace vantage
