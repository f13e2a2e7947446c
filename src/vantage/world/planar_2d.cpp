// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/angle.h"
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"
#include "vantage/world/shapes_2d.h"

namespace vantage {
namespace {

/// Smooth closed curve that stays inside its disc: three harmonics of random size and phase.
std::vector<Vec<2>> blob(const Disc& disc, Random& random) {
  std::array<double, 3> size, phase;
  for (std::size_t k = 0; k < 3; ++k) {
    size[k] = random.uniform(0.3, 1.0) * 0.22 / (1.0 + static_cast<double>(k));
    phase[k] = random.uniform(0.0, 2.0 * kPi);
  }
  const double whole = 1.0 + size[0] + size[1] + size[2];
  return round_polygon(disc.center, 100, [&](double angle) {
    double r = 1.0;
    for (std::size_t k = 0; k < 3; ++k) r += size[k] * sin_cos(static_cast<double>(k + 2) * angle + phase[k])[0];
    return disc.radius * r / whole;
  });
}

}  // namespace

Scene<2> make_planar(int blobs, std::uint64_t seed) {
  const SceneSetting<2> setting{.name = "planar",
                                .domain = {Vec<2>(0.0, 0.0), Vec<2>(20.0, 20.0)},
                                .start = Vec<2>(2.0, 2.0),
                                .voxel = 0.2,
                                .eta = 0.04,
                                .range = 40.0,
                                .clearance = 0.4};
  Random random(seed);
  Scenery<2> scenery;
  const std::vector<Disc> discs = scatter_discs(setting.domain.grown(-1.2), blobs, {2.2, 3.4}, 1.2, {setting.start, 0.0}, random);
  for (const Disc& disc : discs) add_polygon(scenery["blob"], blob(disc, random));
  return scenery.scene(setting);
}

}  // namespace vantage
