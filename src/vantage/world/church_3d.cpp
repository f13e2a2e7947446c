// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/buildings_3d.h"
#include "vantage/world/generators.h"
#include "vantage/world/outdoors_3d.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {

Scene<3> make_church(std::uint64_t seed) {
  const SceneSetting<3> setting{.name = "church",
                                .domain = {Vec<3>(0.0, 0.0, -0.5), Vec<3>(50.0, 50.0, 21.0)},
                                .start = Vec<3>(4.0, 22.0, 2.0),
                                .voxel = 0.5,
                                .eta = 0.08,
                                .range = 80.0,
                                .clearance = 0.5};
  Random random(seed);
  Scenery<3> scenery;
  add_ground(scenery["ground"], {Vec<2>(-20.0, -20.0), Vec<2>(70.0, 70.0)}, 0.0, 10.0);
  const auto facing = [](double x, double y, double quarters) { return Placement<3>{Vec<3>(x, y, 0.0)}.at(Vec<3>::Zero(), quarters * 0.5 * kPi); };

  const Placement<3> church = facing(9.0, 26.0, -1.0);  // Its front looks west.
  add_church(scenery, church);
  for (double y = 10.0; y < kChurchLength; y += 9.0) {
    for (const double x : {8.3, -8.3}) {
      const Vec<3> foot = church({x, y + random.uniform(-1.0, 1.0), 0.0});
      add_tree(scenery, foot.head<2>(), random.uniform(5.0, 6.5), random);
    }
  }

  using Roof = House::Roof;
  const auto depth = [&] { return random.uniform(7.8, 8.8); };
  add_house(scenery, facing(15.5, 9.6, 2.0), {.width = 11.5, .depth = depth(), .storeys = 2, .roof = Roof::gable}, random);  // South of the street,
  add_house(scenery, facing(30.0, 9.4, 2.0), {.width = 9.5, .depth = depth(), .storeys = 1, .roof = Roof::hip}, random);     // looking north.
  add_house(scenery, facing(47.5, 9.6, 2.0), {.width = 12.0, .depth = depth(), .storeys = 2, .rooms = 4, .roof = Roof::flat}, random);
  add_house(scenery, facing(4.0, 40.0, 0.0), {.width = 10.5, .depth = depth(), .storeys = 1, .roof = Roof::gable_to_street, .annex = true}, random);
  add_house(scenery, facing(24.0, 39.8, 0.0), {.width = 13.0, .depth = depth(), .storeys = 2, .rooms = 4, .roof = Roof::gable}, random);

  add_yard_wall(scenery, {}, {Vec<2>(39.0, 38.0), Vec<2>(48.5, 48.0)}, 2.0, {{Vec<2>(42.5, 37.5), Vec<2>(45.0, 39.0)}});
  add_tree(scenery, {44.0, 44.0}, 7.0, random);
  add_box(scenery["kerb"], {}, {Vec<3>(0.0, 10.4, -0.3), Vec<3>(50.0, 11.8, 0.12)});
  const std::array<Vec<2>, 3> poles{Vec<2>(2.0, 11.3), Vec<2>(24.0, 11.3), Vec<2>(48.0, 11.3)};
  add_power_line(scenery, poles);
  for (const double x : {10.0, 21.0, 35.0}) add_car(scenery, facing(x + random.uniform(-1.5, 1.5), 13.2, 0.0), random);
  add_fountain(scenery, {4.5, 31.0});
  return scenery.scene(setting);
}

}  // namespace vantage
