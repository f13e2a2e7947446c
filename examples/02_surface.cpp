// SPDX-License-Identifier: Apache-2.0
// 2 Surface. Points become few flat pieces, none farther than eta from its data, and no measured point lost: a wall, and a wire before it.
#include <fmt/core.h>

#include "vantage/surface/surface.h"

using namespace vantage;

namespace {

/// A wall of 8 m x 4 m in the plane y = 0, and a wire along x at 1 m from it.
std::vector<Vec<3>> wall_and_wire() {
  std::vector<Vec<3>> points;
  for (int i = 0; i <= 160; ++i)
    for (int k = 0; k <= 80; ++k) points.emplace_back(0.05 * i, 0.0, 0.05 * k);
  for (int i = 0; i <= 160; ++i) points.emplace_back(0.05 * i, 1.0, 3.0);
  return points;
}

}  // namespace

int main() {
  SurfaceOptions options;
  options.eta = 0.05;  // [m]
  HausdorffTree<3> tree({Vec<3>(-1, -1, -1), Vec<3>(9, 3, 5)}, options);
  tree.insert(wall_and_wire());

  const SurfaceStatistics s = tree.statistics();
  fmt::print("{} points -> {} polygons, {} segments, {} loose points, depth {}\n", s.points, s.fits, s.segments, s.loose_points, s.depth);
  fmt::print("certified: data to surface {:.4f} m, surface to data {:.4f} m, eta {} m\n", s.data_to_surface, s.surface_to_data, s.eta);

  double area = 0.0, wire = 0.0;
  for (const Patch<3>& patch : tree.patches()) {
    area += measure(patch);
    if (patch.rank() == 1) wire += (patch.vertices[1] - patch.vertices[0]).norm();
  }
  fmt::print("wall {:.1f} m2 of 32, wire {:.1f} m of 8\n", area, wire);

  // A later scan is simply inserted; the same points in any order give the same tree, bit for bit.
  const SurfaceUpdate<3> update = tree.insert(std::vector{Vec<3>(4.0, 2.0, 1.0)});
  fmt::print("one point more: {} accepted, {} loose now\n", update.points, tree.statistics().loose_points);
  return s.certified() <= options.eta && area > 30.0 && update.points == 1 ? 0 : 1;
}
