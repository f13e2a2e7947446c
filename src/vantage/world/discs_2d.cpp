// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"
#include "vantage/world/shapes_2d.h"

namespace vantage {

Scene<2> make_discs(int discs, std::uint64_t seed) {
  const SceneSetting<2> setting{.name = "discs",
                                .domain = {Vec<2>(0.0, 0.0), Vec<2>(30.0, 30.0)},
                                .start = Vec<2>(2.0, 2.0),
                                .voxel = 0.25,
                                .eta = 0.05,
                                .range = 60.0,
                                .clearance = 0.5};
  Random random(seed);
  Scenery<2> scenery;
  for (const Disc& disc : scatter_discs(setting.domain.grown(-1.5), discs, {0.8, 3.0}, 1.5, {setting.start, 0.0}, random))
    add_polygon(scenery["disc"], round_polygon(disc.center, 64, [&](double) { return disc.radius; }));
  return scenery.scene(setting);
}

}  // namespace vantage
