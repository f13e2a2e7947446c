// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "vantage/world/blocks.h"
#include "vantage/world/floor_plan.h"
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"

namespace vantage {
namespace {

const Vec<2> kLot(24.0, 30.0);  // [m]

/// A hollow house about the middle of its lot: rooms, doors to the front and the back, windows, sometimes a walled yard with a gate.
Blocks<2> draw_house(Random& random) {
  constexpr double kYard = 7.0;
  const FloorPlanOptions options{.rooms = 2 + static_cast<int>(random.below(4)), .wall = 0.4, .window = 1.2, .min_side = 3.0};
  const Vec<2> half{random.uniform(5.5, 8.0), random.uniform(4.5, 6.5)};
  const Box<2> outer{-half, half};
  const FloorPlan plan = plan_rooms(outer.grown(-options.wall), options, random);
  Blocks<2> house;
  if (random.uniform() < 0.4) {
    const double x = half[0], y = half[1];
    house.fill({Vec<2>(-x, y), Vec<2>(x, y + kYard)}).carve({Vec<2>(options.wall - x, y), Vec<2>(x - options.wall, y + kYard - options.wall)});
    house.carve({Vec<2>(-1.5, y + kYard - options.wall), Vec<2>(1.5, y + kYard)});
  }
  house.fill(outer);
  const std::vector<Box<2>> entrances{entrance(plan, false, options), entrance(plan, true, options)};
  for (const auto& openings : {plan.rooms, plan.doors, entrances, windows(plan, entrances, options)})
    for (const Box<2>& box : openings) house.carve(box);
  return house;
}

}  // namespace

Scene<2> make_town2d(int houses, std::uint64_t seed) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(houses * 4.0 / 3.0))), rows = (houses + columns - 1) / columns;
  const Box<2> domain{Vec<2>::Zero(), kLot.cwiseProduct(Vec<2>(columns, rows))};
  const Box<2> shore = domain.grown(-1.0);
  const Vec<2> corner = kLot.cwiseProduct(Vec<2>(columns / 2, rows / 2));  // Where four lots meet.
  const SceneSetting<2> setting{
      .name = "town2d", .domain = domain, .start = corner.cwiseMax(shore.low), .voxel = 0.4, .eta = 0.08, .range = 80.0, .clearance = 0.5};
  Random random(seed);
  Scenery<2> scenery;
  for (int i = 0; i < houses; ++i) {
    const Blocks<2> house = draw_house(random);
    const Vec<2> middle = kLot.cwiseProduct(Vec<2>(i % columns + 0.5, i / columns + 0.5)) - Vec<2>(0.0, 2.5);
    const Vec<2> shift{random.uniform(-1.5, 1.5), random.uniform(-2.0, 2.0)};
    house.append_to(scenery["house"], Placement<2>{middle + shift}.at(Vec<2>::Zero(), random.uniform(-0.12, 0.12)));
  }
  return scenery.scene(setting);
}

}  // namespace vantage
