// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/walls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "vantage/audit/oracle.h"
#include "vantage/audit/test_scenes.h"
#include "vantage/audit/thin_parts.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

using namespace test;

template <class Dimension>
class WallsOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(WallsOf, Dimensions);

template <int Dim>
struct World {
  World(Mesh<Dim> m, Box<Dim> d, Vec<Dim> s, double range = 80.0) : mesh(std::move(m)), domain(d), start(s), truth(mesh) {
    ReferenceOptions options;
    options.voxel = 0.5;
    options.clearance = 0.3;
    options.range = range;
    options.rays = 200;
    reference = make_reference(truth, domain, start, options);
  }
  Walls<Dim> walls(const WallOptions& options = {.places = 4000}) const { return reachable_walls(reference, scene(), truth, options); }
  Scene<Dim> scene() const {
    Scene<Dim> scene;
    scene.mesh = mesh;
    scene.domain = domain;
    scene.parts = parts;
    return scene;
  }

  Mesh<Dim> mesh;
  std::vector<typename Scene<Dim>::Part> parts;
  Box<Dim> domain;
  Vec<Dim> start;
  RayCaster<Dim> truth;
  Reference<Dim> reference;
};

/// Surface of a cube of that side [m^(Dim-1)].
template <int Dim>
double hull(double side) {
  return 2 * Dim * std::pow(side, Dim - 1);
}

TYPED_TEST(WallsOf, AllOfAnEmptyRoom) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  add_box(mesh, cube<Dim>(0.3, 7.7));
  const World<Dim> world(mesh, cube<Dim>(0.0, 8.0), place<Dim>(3.5, 3.0));
  const Walls<Dim> walls = world.walls();
  EXPECT_EQ(walls.places.size(), 4000U);
  EXPECT_NEAR(walls.area, hull<Dim>(7.4), 1e-9);
  const Vec<Dim> centre = Vec<Dim>::Constant(4.0);
  for (std::size_t k = 0; k < walls.places.size(); ++k) {
    EXPECT_NEAR(std::abs((walls.places[k] - centre).dot(walls.normals[k])), 3.7, 1e-9);  // On the wall whose normal it is.
    EXPECT_TRUE(walls.sees(world.truth, walls.views[k], k));
    EXPECT_TRUE(walls.sees(world.truth, centre, k));  // Cosines from the centre are at least 1/sqrt(Dim).
  }
  EXPECT_EQ(walls_seen<Dim>(walls, world.truth, std::vector{centre}), std::vector<double>{1.0});
}

TYPED_TEST(WallsOf, WhatStandsOutsideOrInsideASolidIsLeftOut) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  add_box(mesh, cube<Dim>(0.3, 7.7));
  add_box(mesh, cube<Dim>(5.0, 6.5));   // A closed box: its outside counts,
  add_box(mesh, cube<Dim>(5.4, 6.0));   // what is in it does not,
  add_box(mesh, cube<Dim>(9.0, 12.0));  // nor what lies outside the domain.
  const World<Dim> world(mesh, cube<Dim>(0.0, 8.0), place<Dim>(3.5, 3.0));
  const Walls<Dim> walls = world.walls({.places = 20000});
  const double expected = hull<Dim>(7.4) + hull<Dim>(1.5);
  EXPECT_NEAR(walls.area, expected, 0.01 * expected);
  for (const Vec<Dim>& p : walls.places) EXPECT_FALSE(cube<Dim>(5.3, 6.1).contains(p));
}

TYPED_TEST(WallsOf, ClutterCountsOnlyWhereAskedFor) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  add_box(mesh, cube<Dim>(0.3, 7.7));
  const auto room = static_cast<std::uint32_t>(mesh.facets.size());
  add_box(mesh, cube<Dim>(5.0, 6.5));
  World<Dim> world(mesh, cube<Dim>(0.0, 8.0), place<Dim>(3.5, 3.0));
  world.parts = {{"wall", 0, room}, {"vehicle", room, room}};
  EXPECT_NEAR(world.walls().area, hull<Dim>(7.4), 0.02 * hull<Dim>(7.4));
  const double all = hull<Dim>(7.4) + hull<Dim>(1.5);
  EXPECT_NEAR(world.walls({.places = 4000, .clutter = true}).area, all, 0.02 * all);
}

/// In a long corridor the walls are seen from its middle as far as the cosine allows.
TEST(Walls, FlatLooksDoNotCount) {
  Mesh<2> mesh;
  add_box(mesh, Box<2>{{0.0, 0.0}, {60.0, 2.0}});
  const World<2> world(mesh, Box<2>{{0.0, 0.0}, {60.0, 2.0}}, {30.0, 1.0});
  const double cosine = 0.1;
  const Walls<2> walls = world.walls({.places = 20000, .cosine = cosine});
  EXPECT_NEAR(walls.area, 124.0, 1e-6);
  const double reach = std::sqrt(1.0 / (cosine * cosine) - 1.0);  // At a distance of 1 m.
  const std::vector<Vec<2>> middle{{30.0, 1.0}};
  EXPECT_NEAR(walls_seen<2>(walls, world.truth, middle).front(), (4.0 * reach + 4.0) / 124.0, 0.015);
  const std::vector<Vec<2>> two{{15.0, 1.0}, {45.0, 1.0}};
  const std::vector<double> seen = walls_seen<2>(walls, world.truth, two);
  EXPECT_NEAR(seen[0], (4.0 * reach + 4.0) / 124.0, 0.015);
  EXPECT_NEAR(seen[1], (8.0 * reach + 4.0) / 124.0, 0.015);
}

TYPED_TEST(WallsOf, BeyondTheRangeNothingIsSeen) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  add_box(mesh, cube<Dim>(0.3, 7.7));
  const World<Dim> world(mesh, cube<Dim>(0.0, 8.0), place<Dim>(3.5, 3.0), 2.0);
  const Walls<Dim> walls = world.walls();
  EXPECT_EQ(walls.places.size(), 4000U);  // One can walk there.
  EXPECT_EQ(walls_seen<Dim>(walls, world.truth, std::vector<Vec<Dim>>{Vec<Dim>::Constant(4.0)}), std::vector<double>{0.0});
}

TYPED_TEST(WallsOf, SameForAnyNumberOfThreadsAnotherForAnotherSeed) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> world(pillars<Dim>(), cube<Dim>(0.0, 9.0), place<Dim>(3.0, 2.9));
  const auto with = [&](int threads, std::int64_t seed) {
    const ThreadLimit limit(threads);
    return world.walls({.places = 500, .seed = seed});
  };
  const Walls<Dim> one = with(1, 1), seven = with(7, 1);
  EXPECT_EQ(one.places, seven.places);
  EXPECT_EQ(one.views, seven.views);
  EXPECT_NE(with(1, 2).places, one.places);
  EXPECT_THROW((void)with(1, -1), Error);
}

// The oracle that must also see the walls -----------------------------------------------------------------------------------------------------------

void set(std::vector<std::uint64_t>& row, std::size_t column) { row[column / 64] |= std::uint64_t{1} << (column % 64); }

/// Rows of targets and walls by hand; every place sees every other.
SightTable<2> table_of(std::size_t targets, std::size_t walls, const std::vector<std::pair<std::vector<int>, std::vector<int>>>& sights) {
  SightTable<2> table;
  table.targets = targets;
  table.walls = walls;
  table.candidates.assign(sights.size(), Vec<2>::Zero());
  for (const auto& [volume, wall] : sights) {
    table.rows.emplace_back((targets + sights.size() + 63) / 64);
    table.wall_rows.emplace_back((walls + 63) / 64);
    for (const int t : volume) set(table.rows.back(), static_cast<std::size_t>(t));
    for (const int w : wall) set(table.wall_rows.back(), static_cast<std::size_t>(w));
    for (std::size_t c = 0; c < sights.size(); ++c) set(table.rows.back(), targets + c);
  }
  return table;
}

TEST(WallOracle, GoesOnForTheWalls) {
  const SightTable<2> table = table_of(4, 3, {{{0, 1}, {0}}, {{1, 2, 3}, {}}, {{3}, {1, 2}}});
  const OracleRun volume = greedy_oracle(table);
  EXPECT_EQ(volume.places, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(volume.coverage, (std::vector<double>{0.5, 1.0}));
  EXPECT_EQ(volume.walls, (std::vector<double>{1.0 / 3.0, 1.0 / 3.0}));
  EXPECT_EQ(volume.scans_to_both(0.99), std::nullopt);
  const OracleRun both = greedy_oracle(table, {.walls = true});
  EXPECT_EQ(both.places, (std::vector<std::size_t>{0, 2, 1}));  // 1/4 + 2/3 against 2/4.
  EXPECT_EQ(both.scans_to(0.99), 3);
  EXPECT_EQ(both.scans_to_both(0.99), 3);
  EXPECT_EQ(both.scans_to_both(0.75), 2);
}

TEST(WallOracle, WithoutWallsItIsTheOther) {
  const SightTable<2> table = table_of(4, 0, {{{0, 1}, {}}, {{1, 2, 3}, {}}, {{3}, {}}});
  const OracleRun both = greedy_oracle(table, {.walls = true});
  EXPECT_EQ(both.places, greedy_oracle(table).places);
  EXPECT_EQ(both.scans_to_both(0.99), 2);
}

TEST(WallOracle, NothingBeyondTheGoalIsWorthAScan) {
  // The start sees 3 of 4 targets; with the goal of 3/4 only the walls are left, and the place that sees the last target as well is no better.
  const SightTable<2> table = table_of(4, 2, {{{0, 1, 2}, {}}, {{}, {0, 1}}, {{3}, {0, 1}}, {{3}, {}}});
  EXPECT_EQ(greedy_oracle(table, {.walls = true, .goal = 0.75}).places, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(greedy_oracle(table, {.walls = true, .goal = 1.0}).places, (std::vector<std::size_t>{0, 2}));
}

TEST(WallOracle, LazyEqualsEvaluatingAll) {
  Random random(5);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<std::pair<std::vector<int>, std::vector<int>>> sights(1 + random.below(30));
    const auto targets = static_cast<int>(1 + random.below(150)), walls = static_cast<int>(1 + random.below(150));
    for (auto& [volume, wall] : sights) {
      for (int t = 0; t < targets; ++t)
        if (random.uniform() < 0.15) volume.push_back(t);
      for (int w = 0; w < walls; ++w)
        if (random.uniform() < 0.15) wall.push_back(w);
    }
    const SightTable<2> table = table_of(static_cast<std::size_t>(targets), static_cast<std::size_t>(walls), sights);
    for (const bool from_seen : {false, true}) {
      const OracleRun lazy = greedy_oracle(table, {.from_seen = from_seen, .walls = true, .goal = 0.9});
      const OracleRun all = greedy_oracle(table, {.from_seen = from_seen, .walls = true, .goal = 0.9, .lazy = false});
      EXPECT_EQ(lazy.places, all.places) << trial;
      EXPECT_EQ(lazy.walls, all.walls) << trial;
    }
  }
}

TYPED_TEST(WallsOf, TableHoldsTrueSightOfTheWallsAndMovesItsStart) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> world(pillars<Dim>(), cube<Dim>(0.0, 9.0), place<Dim>(3.0, 2.9));
  const Walls<Dim> walls = world.walls({.places = 300});
  const SightInput<Dim> input{world.reference, world.truth, &walls};
  const OracleOptions options{.targets = 400, .candidates = 8};
  const SightTable<Dim> table = make_sight_table(input, world.start, options);
  ASSERT_EQ(table.walls, walls.places.size());
  ASSERT_GT(table.candidates.size(), 9U);  // Eight places do not see all of it.
  for (std::size_t c = 0; c < table.candidates.size(); ++c)
    for (std::size_t k = 0; k < table.walls; ++k) EXPECT_EQ(table.sees_wall(c, k), walls.sees(world.truth, table.candidates[c], k));
  const Vec<Dim> other = place<Dim>(6.2, 6.0);
  SightTable<Dim> moved = table;
  move_start(moved, input, other);
  const SightTable<Dim> anew = make_sight_table(input, other, options);
  EXPECT_EQ(moved.candidates, anew.candidates);
  EXPECT_EQ(moved.rows, anew.rows);
  EXPECT_EQ(moved.wall_rows, anew.wall_rows);
  EXPECT_NE(moved.rows, table.rows);
}

/// Two rooms with a door beside the wall: from the door all volume is in sight at once, but the faces of the wall only flatly.
TYPED_TEST(WallsOf, WallsNeedNoFewerScans) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> world(two_rooms<Dim>(5.0), cube<Dim>(0.0, 8.0), place<Dim>(3.5, 3.0));
  const Walls<Dim> walls = world.walls({.places = 1000});
  const SightTable<Dim> table = make_sight_table<Dim>({world.reference, world.truth, &walls}, world.start, {.targets = 1000, .candidates = 100});
  const auto volume = greedy_oracle(table).scans_to(0.99), both = greedy_oracle(table, {.walls = true}).scans_to_both(0.99);
  ASSERT_TRUE(volume && both);
  EXPECT_GE(*both, *volume);
}

// Thin parts ----------------------------------------------------------------------------------------------------------------------------------------

TYPED_TEST(WallsOf, ThinPartsCountWhereObserved) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> scene;
  Vec<Dim> edge = Vec<Dim>::Zero();
  edge[0] = 20.0;
  std::vector<Vec<Dim>> edges(Dim - 1, Vec<Dim>::Zero());
  for (int a = 0; a + 1 < Dim; ++a) edges[static_cast<std::size_t>(a)][a] = a == 0 ? 20.0 : 0.04;  // Long and thin.
  add_face(scene.mesh, Vec<Dim>::Zero(), edges);
  EXPECT_TRUE(ThinParts<Dim>(scene).empty());
  scene.parts.push_back({"wire", 0, static_cast<std::uint32_t>(scene.mesh.facets.size())});
  ThinParts<Dim> thin(scene);
  EXPECT_FALSE(thin.empty());
  const std::vector<Patch<Dim>> none;
  EXPECT_EQ(thin.recall(none), std::nullopt);
  std::vector<Vec<Dim>> returns;
  for (double x = 0.0; x <= 0.5; x += 0.001) returns.push_back(x * edge);  // The first half was observed.
  thin.observe(returns);
  EXPECT_EQ(thin.recall(none), 0.0);
  const std::vector<Patch<Dim>> whole{segment_patch<Dim>(Vec<Dim>::Zero(), edge)};
  EXPECT_EQ(thin.recall(whole), 1.0);
  const std::vector<Patch<Dim>> part{segment_patch<Dim>(Vec<Dim>::Zero(), Vec<Dim>(0.25 * edge))};
  EXPECT_NEAR(thin.recall(part).value(), 0.5, 0.12);
}

}  // namespace
}  // namespace vantage
