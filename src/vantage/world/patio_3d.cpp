// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/blocks.h"
#include "vantage/world/generators.h"
#include "vantage/world/outdoors_3d.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

Box<3> block(double x0, double x1, double y0, double y1, double z0, double z1) { return {Vec<3>(x0, y0, z0), Vec<3>(x1, y1, z1)}; }

/// The edge of a building, open towards the patio: a colonnade under a flat roof before two rooms.
void add_loggia(Scenery<3>& scenery) {
  Blocks<3> body;
  body.fill(block(0.5, 19.5, 16.8, 23.0, -0.3, 3.4)).fill(block(0.5, 19.5, 13.6, 23.0, 3.1, 3.5));
  body.carve(block(0.8, 8.6, 17.1, 22.7, 0.05, 3.1)).carve(block(8.9, 19.2, 17.1, 22.7, 0.05, 3.1));
  body.carve(block(3.6, 5.4, 16.8, 17.1, 0.05, 2.3)).carve(block(13.0, 15.4, 16.8, 17.1, 0.05, 2.3));  // Doors,
  body.carve(block(8.6, 8.9, 19.0, 20.8, 0.05, 2.3));                                                  // between the rooms,
  for (const double x : {1.4, 6.4, 10.2, 16.6}) body.carve(block(x, x + 1.5, 16.8, 17.1, 0.9, 2.3));   // and windows.
  body.append_to(scenery["house"]);
  for (const double x : {1.2, 4.7, 8.2, 11.8, 15.3, 18.8}) add_cylinder(scenery["column"], {x, 14.0, -0.3}, {x, 14.0, 3.15}, 0.22, 12);
}

/// Posts and beams that carry no roof, on the left.
void add_pergola(Scenery<3>& scenery) {
  for (const double y : {2.5, 5.5, 8.5, 11.5}) {
    for (const double x : {1.5, 4.3}) add_cylinder(scenery["column"], {x, y, -0.3}, {x, y, 2.75}, 0.15, 10);
    add_box(scenery["column"], {}, block(1.1, 4.7, y - 0.08, y + 0.08, 2.7, 2.9));
  }
}

/// Knee-high walls round the front, with two ways in.
void add_low_walls(Scenery<3>& scenery) {
  Blocks<3> walls;
  walls.fill(block(0.4, 19.6, 0.6, 0.9, -0.3, 0.8)).fill(block(19.3, 19.6, 0.6, 12.0, -0.3, 0.8));
  walls.carve(block(8.6, 11.0, 0.6, 0.9, -0.3, 0.8)).carve(block(19.3, 19.6, 6.0, 8.4, -0.3, 0.8));
  walls.append_to(scenery["wall"]);
  for (const double x : {6.6, 11.8}) add_box(scenery["wall"], {}, block(x, x + 1.4, 1.6, 2.6, -0.3, 0.55));  // Planters.
}

}  // namespace

Scene<3> make_patio(std::uint64_t seed) {
  const SceneSetting<3> setting{.name = "patio",
                                .domain = {Vec<3>(0.0, 0.0, -1.0 / 3.0), Vec<3>(20.0, 20.0, 8.0)},
                                .start = Vec<3>(9.8, 4.4, 1.6),
                                .voxel = 1.0 / 3.0,
                                .eta = 0.04,
                                .range = 80.0,
                                .clearance = 0.4};
  Random random(seed);
  Scenery<3> scenery;
  add_ground(scenery["ground"], {Vec<2>(-10.0, -10.0), Vec<2>(30.0, 30.0)}, 0.0, 5.0);
  add_loggia(scenery);
  add_pergola(scenery);
  add_low_walls(scenery);
  for (const Vec<2>& spot : {Vec<2>(7.6, 7.4), Vec<2>(12.2, 7.6), Vec<2>(7.7, 11.2), Vec<2>(12.4, 11.1), Vec<2>(16.2, 4.2)}) {
    const Vec<3> place{spot[0] + random.uniform(-0.3, 0.3), spot[1] + random.uniform(-0.3, 0.3), 0.0};
    add_table(scenery, Placement<3>{place}.at(Vec<3>::Zero(), random.uniform(-0.4, 0.4)));
  }
  for (const Vec<2>& spot : {Vec<2>(14.6, 9.4), Vec<2>(10.0, 9.3), Vec<2>(17.3, 9.9), Vec<2>(5.6, 4.0)}) {
    const Vec<2> foot{spot[0] + random.uniform(-0.3, 0.3), spot[1] + random.uniform(-0.3, 0.3)};
    add_tree(scenery, foot, random.uniform(5.5, 7.0), random);
  }
  return scenery.scene(setting);
}

}  // namespace vantage
