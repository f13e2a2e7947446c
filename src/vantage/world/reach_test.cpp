// SPDX-License-Identifier: Apache-2.0
// Every place of the built-in scenes can be reached: doors, gates and stairs are passable on the scene's own lattice, and no void is closed.
#include <gtest/gtest.h>

#include <deque>

#include "vantage/field/grid.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/world/buildings_3d.h"
#include "vantage/world/inside_solid.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

/// Nodes of the scene's lattice, from its start over steps along the axes, that keep the clearance; and those that keep it but are neither among
/// them nor next to one of them (a node right in a window may be alone).
template <int Dim>
struct Reach {
  std::size_t reached = 0;
  std::vector<Vec<Dim>> cut_off;
};

template <int Dim>
Reach<Dim> explore_all(const Scene<Dim>& scene) {
  const RayCaster<Dim> world(scene.mesh);
  const Grid<Dim> grid = window_over(scene.domain, scene.voxel);
  enum class Node : char { blocked, open, reached };
  std::vector<Node> nodes(grid.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec<Dim> p = grid.position(i);
    const bool above_ground = p[Dim - 1] >= 0.0;
    nodes[i] = above_ground && world.distance(p, scene.clearance + 1e-9) >= scene.clearance ? Node::open : Node::blocked;
  }
  std::deque<Index<Dim>> front{grid.nearest(scene.start)};
  Reach<Dim> reach;
  while (!front.empty()) {
    const Index<Dim> at = front.front();
    front.pop_front();
    if (!grid.inside(at) || nodes[grid.linear(at)] != Node::open) continue;
    nodes[grid.linear(at)] = Node::reached;
    ++reach.reached;
    for (int a = 0; a < Dim; ++a)
      for (const int step : {-1, 1}) front.push_back(at + step * Index<Dim>::Unit(a));
  }
  const Grid<Dim> block{1.0, Index<Dim>::Constant(-1), Index<Dim>::Constant(3)};
  const auto beside_reached = [&](std::size_t i) {
    for (std::size_t k = 0; k < block.size(); ++k) {
      const Index<Dim> near = grid.local(i) + block.first + block.local(k);
      if (grid.inside(near) && nodes[grid.linear(near)] == Node::reached) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i] == Node::open && !beside_reached(i) && !inside_solid(world, grid.position(i))) reach.cut_off.push_back(grid.position(i));
  return reach;
}

template <int Dim>
void expect_all_reached(const Scene<Dim>& scene, std::size_t at_least) {
  const Reach<Dim> reach = explore_all(scene);
  EXPECT_GE(reach.reached, at_least);
  EXPECT_EQ(reach.cut_off.size(), 0u) << "first at " << (reach.cut_off.empty() ? Vec<Dim>(Vec<Dim>::Zero()) : reach.cut_off[0]).transpose();
}

/// What `add` builds, on ground, in a domain of its own that is 2 m larger, with the start in front.
template <class Add>
Scene<3> alone(const Add& add) {
  Scenery<3> scenery;
  add(scenery);
  Box<3> box = scenery.scene({}).mesh.bounds();
  box.low -= Vec<3>(2.0, 2.0, 0.0);
  box.high += Vec<3>::Constant(2.0);
  add_ground(scenery["ground"], {box.low.head<2>(), box.high.head<2>()}, 0.0, 5.0);
  return scenery.scene({.name = "alone",
                        .domain = box,
                        .start = Vec<3>(box.low[0] + 0.6, box.low[1] + 0.6, 1.5),
                        .voxel = 0.5,
                        .eta = 0.1,
                        .range = 80.0,
                        .clearance = 0.5});
}

TEST(Reach, EveryRoomOfEveryHouse) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    House house{.width = random.uniform(8.0, 13.0), .depth = random.uniform(7.6, 10.4), .storeys = 1 + static_cast<int>(seed % 2)};
    house.rooms = 2 + static_cast<int>(seed % 3);
    house.roof = static_cast<House::Roof>(seed % 4);
    house.annex = seed % 3 == 0;
    house.court = seed % 4 == 1;
    const Placement<3> place = Placement<3>{}.at(Vec<3>::Zero(), random.uniform(0.0, 6.0));
    expect_all_reached(alone([&](Scenery<3>& scenery) { add_house(scenery, place, house, random); }), 1000);
  }
}

TEST(Reach, EveryPlaceOfChurchAndHall) {
  expect_all_reached(alone([](Scenery<3>& scenery) { add_church(scenery, {}); }), 10000);
  expect_all_reached(alone([](Scenery<3>& scenery) { add_hall(scenery, {}); }), 5000);
}

TEST(Reach, DoorsAreThreeStepsWide) {
  for (const char* name : {"office", "town2d:houses=4", "blocks:columns=3,rows=3"}) {
    SCOPED_TRACE(name);
    auto scene = std::get<Scene<2>>(make_scene(name));
    scene.clearance = 1.5 * scene.voxel - 1e-6;  // Of a disc three steps wide, on a finer lattice.
    scene.voxel *= 0.5;
    expect_all_reached(scene, 1000);
  }
  Random random(3);
  Scene<3> scene = alone([&](Scenery<3>& scenery) { add_house(scenery, {}, {.rooms = 4}, random); });
  scene.clearance = 1.5 * scene.voxel;
  scene.voxel *= 0.25;
  scene.start += Vec<3>::Constant(0.3);
  expect_all_reached(scene, 1000);
}

TEST(Reach, TellsARoomWithoutADoor) {
  const Reach<3> reach = explore_all(alone([](Scenery<3>& scenery) { add_yard_wall(scenery, {}, {Vec<2>(0.0, 0.0), Vec<2>(6.0, 6.0)}, 3.0, {}); }));
  EXPECT_EQ(reach.cut_off.size(), 0u);  // Open above.
  const Reach<3> closed = explore_all(alone([](Scenery<3>& scenery) {
    add_yard_wall(scenery, {}, {Vec<2>(0.0, 0.0), Vec<2>(6.0, 6.0)}, 3.0, {});
    add_box(scenery["roof"], {}, {Vec<3>(-0.2, -0.2, 2.9), Vec<3>(6.2, 6.2, 3.2)});
  }));
  EXPECT_GT(closed.cut_off.size(), 100u);
}

TEST(Reach, EveryRoomOfEveryFloor) {
  for (const char* spec : {"floor:rooms=12,seed=1", "floor:rooms=13,seed=2", "floor:rooms=14,seed=3", "floor:rooms=15,seed=4"}) {
    SCOPED_TRACE(spec);
    auto scene = std::get<Scene<3>>(make_scene(spec));
    expect_all_reached(scene, 3000);
    scene.clearance = 1.5 * scene.voxel - 1e-6;  // Doors are three steps wide.
    scene.voxel *= 0.5;
    expect_all_reached(scene, 15000);
  }
}

TEST(Reach, EveryGalleryOfEveryMine) {
  for (const char* spec : {"galleries:columns=3,rows=2,seed=1", "galleries:columns=2,rows=2,seed=2", "galleries:columns=2,rows=2,seed=3"}) {
    SCOPED_TRACE(spec);
    auto scene = std::get<Scene<3>>(make_scene(spec));
    scene.voxel = 0.8;  // Every way is wide enough for it; half the spacing takes ten times as long.
    expect_all_reached(scene, 1000);
  }
}

TEST(Reach, EveryPlaceOfTheSmallerScenes) {
  for (const SceneInfo& info : scene_list()) {
    if (info.name == "town" || info.name == "floor" || info.name == "galleries") continue;  // Too many nodes for here: see the tests of their parts.
    SCOPED_TRACE(info.name);
    std::visit([](const auto& scene) { expect_all_reached(scene, 1000); }, make_scene(info.name + ":seed=2"));
  }
}

}  // namespace
}  // namespace vantage
