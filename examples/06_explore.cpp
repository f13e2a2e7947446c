// SPDX-License-Identifier: Apache-2.0
// 6 Explore. The whole loop: scan, rebuild, see, unite, choose, go there, until nothing is left to see. Three rooms nobody told it about.
#include <fmt/core.h>

#include "vantage/explore/explore.h"
#include "vantage/geometry/ray_caster.h"

using namespace vantage;

namespace {

/// A planar scanner among walls. The explorer gets the ranges, never the walls.
class Rooms final : public Sensor<2> {
 public:
  explicit Rooms(const Mesh<2>& walls) : caster_(walls) {}
  Scan<2> scan(const Vec<2>& vantage_point, int /*index*/) override {
    Scan<2> scan;
    scan.origin = vantage_point;
    for (const Vec<2>& direction : directions<2>(scan.pattern))
      scan.ranges.push_back(static_cast<float>(caster_.cast(vantage_point, direction, scan.pattern.max_range).range));
    return scan;
  }

 private:
  RayCaster<2> caster_;
};

/// 24 m x 10 m, two inner walls with doors 2 m wide at opposite ends.
Mesh<2> three_rooms() {
  Mesh<2> mesh;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {Vec<2>(x0, y0), Vec<2>(x1, y1)});
    mesh.facets.push_back({first, first + 1});
  };
  wall(0, 0, 24, 0), wall(24, 0, 24, 10), wall(24, 10, 0, 10), wall(0, 10, 0, 0);
  wall(8, 0, 8, 7.5), wall(8, 9.5, 8, 10), wall(16, 0, 16, 0.5), wall(16, 2.5, 16, 10);
  return mesh;
}

}  // namespace

int main() {
  Rooms sensor(three_rooms());
  ExploreOptions options;
  options.voxel = 0.25;
  options.surface.eta = 0.05;
  Explorer<2> explorer(sensor, {{-0.5, -0.5}, {24.5, 10.5}}, {2.0, 2.0}, options);
  while (!explorer.finished()) {
    const StepRecord<2>& step = explorer.step();
    fmt::print("scan {:2} at ({:5.2f}, {:5.2f}): {:5.1f} m2 new, {:5.1f} % seen\n", step.scan, step.vantage.x(), step.vantage.y(), step.new_volume,
               100.0 * step.seen_fraction);
  }
  const Verdict<2> verdict = explorer.verdict();
  fmt::print("{}: {}\n", verdict.complete ? "complete" : "not complete", verdict.reason);
  return verdict.complete && explorer.steps().back().seen_volume > 0.9 * 24.0 * 10.0 ? 0 : 1;
}
