// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/blocks.h"

#include "vantage/base/random.h"
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"

namespace vantage {
namespace {

constexpr double kPitch = 18.6;  // Of the grid of streets [m].
constexpr double kLot = 20.0;    // Of the domain for each block; the rest is open land round the city [m].

Box<2> rectangle(double x0, double x1, double y0, double y1) { return {Vec<2>(x0, y0), Vec<2>(x1, y1)}; }

/// One city block about its own middle: whole, with a corner missing, or round a court with a passage.
Blocks<2> city_block(Random& random) {
  const double x = random.uniform(5.4, 6.8), y = random.uniform(5.2, 6.6), side = random.uniform() < 0.5 ? -1.0 : 1.0;
  Blocks<2> block;
  block.fill(rectangle(-x, x, -y, y));
  switch (random.below(4)) {
    case 0: block.carve(rectangle(side > 0.0 ? 0.4 : -x, side > 0.0 ? x : -0.4, 0.8, y)); break;
    case 1: block.carve(rectangle(-2.5, 2.5, -2.2, 2.2)).carve(rectangle(-1.2, 1.2, side > 0.0 ? 2.2 : -y, side > 0.0 ? y : -2.2)); break;
    default: break;
  }
  return block;
}

}  // namespace

Scene<2> make_blocks(int columns, int rows, std::uint64_t seed) {
  const Vec<2> size(kLot * columns, kLot * rows), middle = 0.5 * size;
  const Placement<2> city = Placement<2>{middle}.at(Vec<2>::Zero(), 0.06);
  const auto crossing = [&](double i, double j) { return Vec<2>(kPitch * (i - 0.5 * columns), kPitch * (j - 0.5 * rows)); };
  const SceneSetting<2> setting{.name = "blocks",
                                .domain = {Vec<2>::Zero(), size},
                                .start = city(crossing(columns / 2, rows / 2)),
                                .voxel = 0.5,
                                .eta = 0.1,
                                .range = 80.0,
                                .clearance = 0.5};
  Random random(seed);
  Scenery<2> scenery;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Blocks<2> block = city_block(random);
      block.append_to(scenery["block"], city.at(crossing(i + 0.5, j + 0.5), random.uniform(-0.05, 0.05)));
    }
  return scenery.scene(setting);
}

}  // namespace vantage
