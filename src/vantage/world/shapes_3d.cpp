// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/shapes_3d.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace vantage {
namespace {

/// Adds the ring's places; returns the index of the first.
std::uint32_t add_ring(Mesh<3>& mesh, const Ring& ring) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  return first;
}

/// Flat end of a loft as a fan.
void add_cap(Mesh<3>& mesh, std::uint32_t first, std::size_t count, bool top) {
  for (std::uint32_t i = 1; i + 1 < count; ++i)
    mesh.facets.push_back(top ? Mesh<3>::Facet{first, first + i, first + i + 1} : Mesh<3>::Facet{first, first + i + 1, first + i});
}

/// Band between two rings that follow each other; a tip turns its quadrilaterals into triangles.
void add_band(Mesh<3>& mesh, std::uint32_t low, std::size_t low_count, std::uint32_t high, std::size_t high_count) {
  const auto count = static_cast<std::uint32_t>(std::max(low_count, high_count));
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count;
    if (low_count > 1) mesh.facets.push_back({low + i, low + j, high_count > 1 ? high + j : high});
    if (high_count > 1) mesh.facets.push_back({low_count > 1 ? low + i : low, high + j, high + i});
  }
}

/// Unit vectors u, v with u x v = axis.
std::array<Vec<3>, 2> across(const Vec<3>& axis) {
  int least = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(axis[a]) < std::abs(axis[least])) least = a;
  const Vec<3> u = axis.cross(Vec<3>::Unit(least)).normalized();
  return {u, axis.cross(u)};
}

}  // namespace

void add_loft(Mesh<3>& mesh, const std::vector<Ring>& rings) {
  std::uint32_t previous = add_ring(mesh, rings.front());
  add_cap(mesh, previous, rings.front().size(), false);
  for (std::size_t k = 1; k < rings.size(); ++k) {
    const std::uint32_t next = add_ring(mesh, rings[k]);
    add_band(mesh, previous, rings[k - 1].size(), next, rings[k].size());
    previous = next;
  }
  add_cap(mesh, previous, rings.back().size(), true);
}

Ring rectangle(const Placement<3>& place, const Box<2>& box, double z) {
  return {place({box.low[0], box.low[1], z}), place({box.high[0], box.low[1], z}), place({box.high[0], box.high[1], z}),
          place({box.low[0], box.high[1], z})};
}

Ring circle(const Vec<3>& center, const Vec<3>& axis, double radius, int sides) {
  const auto [u, v] = across(axis);
  Ring ring;
  for (int i = 0; i < sides; ++i) {
    const auto [s, c] = sin_cos(i * (2.0 * kPi / sides));
    ring.push_back(center + radius * (c * u + s * v));
  }
  return ring;
}

void add_box(Mesh<3>& mesh, const Placement<3>& place, const Box<3>& box) {
  const Box<2> base{box.low.head<2>(), box.high.head<2>()};
  add_loft(mesh, {rectangle(place, base, box.low[2]), rectangle(place, base, box.high[2])});
}

void add_cylinder(Mesh<3>& mesh, const Vec<3>& from, const Vec<3>& to, double radius, int sides) {
  const Vec<3> axis = (to - from).normalized();
  add_loft(mesh, {circle(from, axis, radius, sides), circle(to, axis, radius, sides)});
}

void add_cone(Mesh<3>& mesh, const Vec<3>& from, const Vec<3>& tip, double radius, int sides) {
  add_loft(mesh, {circle(from, (tip - from).normalized(), radius, sides), {tip}});
}

void add_ball(Mesh<3>& mesh, const Vec<3>& center, const Vec<3>& radii, double bumps, Random& random) {
  constexpr int kSides = 7, kRows = 3;
  const auto place = [&](const Vec<3>& direction) {
    return Vec<3>(center + (1.0 + bumps * random.uniform(-1.0, 1.0)) * radii.cwiseProduct(direction));
  };
  std::vector<Ring> rings{{place(-Vec<3>::UnitZ())}};
  for (int row = 1; row <= kRows; ++row) {
    const auto [height, width] = sin_cos((static_cast<double>(row) / (kRows + 1) - 0.5) * kPi);
    Ring ring;
    for (int i = 0; i < kSides; ++i) {
      const auto [s, c] = sin_cos((i + 0.5 * (row % 2)) * (2.0 * kPi / kSides));
      ring.push_back(place({width * c, width * s, height}));
    }
    rings.push_back(ring);
  }
  rings.push_back({place(Vec<3>::UnitZ())});
  add_loft(mesh, rings);
}

void add_wire(Mesh<3>& mesh, const Vec<3>& a, const Vec<3>& b, double sag, double radius) {
  constexpr int kPieces = 16, kSides = 6;
  const Vec<3> axis = (b - a).normalized();
  std::vector<Ring> rings;
  for (int k = 0; k <= kPieces; ++k) {
    const double t = static_cast<double>(k) / kPieces;
    rings.push_back(circle(a + t * (b - a) - 4.0 * sag * t * (1.0 - t) * Vec<3>::UnitZ(), axis, radius, kSides));
  }
  add_loft(mesh, rings);
}

void add_gable_roof(Mesh<3>& mesh, const Placement<3>& place, const Box<2>& base, double z, double rise) {
  const auto gable = [&](double x) { return Ring{place({x, base.low[1], z}), place({x, base.high[1], z}), place({x, base.center()[1], z + rise})}; };
  add_loft(mesh, {gable(base.low[0]), gable(base.high[0])});
}

void add_hip_roof(Mesh<3>& mesh, const Placement<3>& place, const Box<2>& base, double z, double rise) {
  const double inset = 0.5 * base.size().minCoeff() - 0.1;
  add_loft(mesh, {rectangle(place, base, z), rectangle(place, base.grown(-inset), z + rise)});
}

void add_ground(Mesh<3>& mesh, const Box<2>& box, double z, double cell) {
  const auto columns = static_cast<std::uint32_t>(std::max(1.0, std::ceil(box.size()[0] / cell)));
  const auto rows = static_cast<std::uint32_t>(std::max(1.0, std::ceil(box.size()[1] / cell)));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i)
      mesh.vertices.emplace_back(box.low[0] + box.size()[0] * i / columns, box.low[1] + box.size()[1] * j / rows, z);
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = first + j * (columns + 1) + i, b = a + columns + 1;
      mesh.facets.push_back({a, a + 1, b + 1});
      mesh.facets.push_back({a, b + 1, b});
    }
}

}  // namespace vantage
