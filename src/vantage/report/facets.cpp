// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "vantage/base/parallel.h"

namespace vantage {

namespace {

constexpr std::uint32_t kNone = 0xffffffff;

/// Vertices of the cells whose eight corners do not agree, by cell.
struct Net {
  const Field<3>& psi;
  std::vector<std::uint32_t> vertex_of;

  [[nodiscard]] bool in_s(std::size_t node) const { return psi[node] <= 0.0F; }

  /// Mean of the places where the cell's edges cross the level 0; false if none does.
  [[nodiscard]] bool place(const Index<3>& cell, Vec<3>& vertex) const {
    const Grid<3>& grid = psi.window;
    int crossings = 0;
    vertex.setZero();
    for (unsigned corner = 0; corner < 8; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        if ((corner >> axis & 1U) != 0) continue;
        const Index<3> from = cell + Index<3>(corner & 1U, corner >> 1U & 1U, corner >> 2U & 1U);
        const std::size_t a = grid.linear(from), b = a + grid.stride(axis);
        if (in_s(a) == in_s(b)) continue;
        const double va = psi[a], vb = psi[b];
        vertex += grid.position(from) + grid.spacing * std::clamp(va / (va - vb), 0.05, 0.95) * Vec<3>::Unit(axis);
        ++crossings;
      }
    }
    if (crossings > 0) vertex /= crossings;
    return crossings > 0;
  }
};

void add_vertices(Net& net, LevelSurface& surface) {
  const Grid<3>& grid = net.psi.window;
  net.vertex_of.assign(grid.size(), kNone);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Index<3> cell = grid.local(i);
    if (((cell.array() + 1) >= grid.extent.array()).any()) continue;
    Vec<3> vertex;
    if (!net.place(cell, vertex)) continue;
    net.vertex_of[i] = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.push_back(vertex);
  }
}

/// One quadrangle around every lattice edge that crosses the level and has four cells.
void add_quads(const Net& net, const Field<3, NodeState>& state, LevelSurface& surface) {
  const Grid<3>& grid = net.psi.window;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Index<3> node = grid.local(i);
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      if (node[axis] + 1 >= grid.extent[axis] || node[u] == 0 || node[v] == 0 || node[u] + 1 >= grid.extent[u] || node[v] + 1 >= grid.extent[v])
        continue;
      const std::size_t other = i + grid.stride(axis);
      if (net.in_s(i) == net.in_s(other)) continue;
      const std::size_t du = grid.stride(u), dv = grid.stride(v);
      const std::size_t hidden = net.in_s(i) ? i : other;
      surface.quads.push_back(
          {{net.vertex_of[i], net.vertex_of[i - du], net.vertex_of[i - du - dv], net.vertex_of[i - dv]}, state[hidden] == NodeState::obstacle});
    }
  }
}

/// Each vertex goes to the mean of its neighbours, but at most 0.45 cells from where it was.
void relax(LevelSurface& surface, const std::vector<Vec<3>>& home, double reach) {
  std::vector<Vec<3>> sum(surface.vertices.size(), Vec<3>::Zero());
  std::vector<int> count(surface.vertices.size(), 0);
  for (const LevelSurface::Quad& quad : surface.quads) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t here = quad.corners[k];
      for (const std::uint32_t there : {quad.corners[(k + 1) % 4], quad.corners[(k + 3) % 4]}) {
        sum[here] += surface.vertices[there];
        ++count[here];
      }
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (count[i] == 0) continue;
    const Vec<3> offset = sum[i] / count[i] - home[i];
    surface.vertices[i] = home[i] + offset.cwiseMax(-reach).cwiseMin(reach);
  }
}

}  // namespace

Rgb lit(const Vec<3>& normal, const Camera& camera, Rgb colour) {
  const Vec<3> towards = normal.dot(camera.forward()) > 0.0 ? Vec<3>(-normal) : normal;
  const Vec<3> sun = (Vec<3>::UnitZ() * 1.1 - camera.forward() * 0.35 - camera.right() * 0.55).normalized();
  return mix(mix(scaled(colour, 0.52), {96, 102, 122}, 0.25), colour, std::clamp(1.08 * towards.dot(sun) + 0.12, 0.0, 1.0));
}

void draw_mesh(Raster& raster, const Mesh<3>& mesh, std::span<const Rgb> colours) {
  parallel_for(mesh.facets.size(), 256, [&](std::size_t i) {
    const auto& facet = mesh.facets[i];
    const std::array<Vec<3>, 3> corners{mesh.vertices[facet[0]], mesh.vertices[facet[1]], mesh.vertices[facet[2]]};
    const Vec<3> normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (normal.norm() > 0.0) raster.polygon(corners, lit(normal.normalized(), raster.camera(), colours[i]));
  });
}

LevelSurface level_surface(const Field<3>& psi, const Field<3, NodeState>& state, int relaxed) {
  LevelSurface surface;
  Net net{psi, {}};
  add_vertices(net, surface);
  add_quads(net, state, surface);
  const std::vector<Vec<3>> home = surface.vertices;
  for (int k = 0; k < relaxed; ++k) relax(surface, home, 0.45 * psi.window.spacing);
  return surface;
}

void draw_level(Raster& raster, const LevelSurface& surface, Rgb known, Rgb unseen) {
  parallel_for(surface.quads.size(), 256, [&](std::size_t i) {
    const LevelSurface::Quad& quad = surface.quads[i];
    std::array<Vec<3>, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = surface.vertices[quad.corners[k]];
    const Vec<3> normal = (p[2] - p[0]).cross(p[3] - p[1]);
    if (!(normal.norm() > 0.0)) return;
    const Rgb colour = lit(normal.normalized(), raster.camera(), quad.known ? known : unseen);
    for (const auto& triangle : {std::array<Vec<3>, 3>{p[0], p[1], p[2]}, std::array<Vec<3>, 3>{p[0], p[2], p[3]}}) raster.polygon(triangle, colour);
  });
}

}  // namespace vantage
