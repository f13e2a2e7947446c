// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/reference.h"

#include <gtest/gtest.h>

#include <cstring>
#include <type_traits>

#include "vantage/audit/test_scenes.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

using namespace test;

template <class Dimension>
class ReferenceOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ReferenceOf, Dimensions);

ReferenceOptions coarse(double voxel = 1.0) {
  ReferenceOptions o;
  o.voxel = voxel;
  o.clearance = 0.6;
  o.rays = 60;
  return o;
}

/// The definition, step by step: no blocks, no layers, no witnesses.
template <int Dim>
struct SlowReference {
  SlowReference(const RayCaster<Dim>& caster, const Grid<Dim>& window, const Vec<Dim>& start, const ReferenceOptions& o)
      : truth(caster), grid(window), options(o), reachable(window.size()), visible(window.size()) {
    stand(start);
    const auto directions = fixed_directions<Dim>(options.rays);
    for (std::size_t i = 0; i < grid.size(); ++i) visible[i] = reachable[i] || looks(i, directions);
  }

  bool clear(std::size_t i) const { return truth.distance(grid.position(i)) >= options.clearance; }

  void stand(const Vec<Dim>& start) {
    reachable[grid.linear(grid.nearest(start))] = true;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t i = 0; i < grid.size(); ++i)
        if (!reachable[i] && clear(i) && step_from_reachable(i)) reachable[i] = changed = true;
    }
  }

  bool step_from_reachable(std::size_t i) const {
    for (int k = 0; k < 2 * Dim; ++k) {
      const Index<Dim> from = grid.local(i) + Index<Dim>::Unit(k / 2) * (k % 2 == 0 ? 1 : -1);
      if (grid.inside(from) && reachable[grid.linear(from)] && in_sight(truth, grid.position(from), grid.position(i))) return true;
    }
    return false;
  }

  bool looks(std::size_t i, const std::vector<Vec<Dim>>& directions) const {
    for (const Vec<Dim>& d : directions) {
      const double end = std::min(options.range, truth.cast(grid.position(i), d).range);
      for (double t = 0.0; t < end; t += 0.5 * grid.spacing) {
        const Index<Dim> at = grid.nearest(grid.position(i) + t * d);
        if (grid.inside(at) && reachable[grid.linear(at)]) return true;
      }
    }
    return false;
  }

  /// Any reachable node in line of sight.
  bool witnessed(std::size_t i) const {
    for (std::size_t j = 0; j < grid.size(); ++j)
      if (reachable[j] && (grid.position(i) - grid.position(j)).norm() <= options.range && in_sight(truth, grid.position(j), grid.position(i)))
        return true;
    return false;
  }

  /// A node of the runs' lattice, at the node or half a spacing of it away along some axes, that nobody takes for an obstacle.
  bool decided(std::size_t i) const {
    for (std::size_t j = 0; j < grid.size(); ++j) {
      const Index<Dim> at = grid.first + grid.local(j), away = at - grid.first - grid.local(i);
      const Index<Dim> here = at - away;
      bool beside = true;
      for (int a = 0; a < Dim; ++a) beside = beside && at[a] % 2 == 0 && std::abs(away[a]) <= std::abs(here[a] % 2);
      if (beside && truth.distance(grid.position(j)) > options.eta + 0.5 * std::sqrt(double{Dim}) * options.voxel) return true;
    }
    return false;
  }

  const RayCaster<Dim>& truth;
  Grid<Dim> grid;
  ReferenceOptions options;
  std::vector<bool> reachable, visible;
};

template <int Dim>
void expect_the_definition(const Mesh<Dim>& mesh, const Box<Dim>& domain, const Vec<Dim>& start, const ReferenceOptions& options) {
  const RayCaster<Dim> truth(mesh);
  const Reference<Dim> fast = make_reference(truth, domain, start, options);
  const SlowReference<Dim> slow(truth, fast.nodes.window, start, options);
  std::size_t counted = 0, seen = 0, hidden = 0;
  for (std::size_t i = 0; i < fast.nodes.values.size(); ++i) {
    const Truth node = fast.nodes[i];
    const double distance = truth.distance(slow.grid.position(i));
    const bool near = distance <= std::max(options.eta, options.voxel) || (node.visible && !slow.decided(i));
    EXPECT_EQ(node.reachable, slow.reachable[i]) << slow.grid.position(i).transpose();
    EXPECT_EQ(node.near, near) << slow.grid.position(i).transpose();
    EXPECT_TRUE(!slow.visible[i] || node.visible) << slow.grid.position(i).transpose();
    EXPECT_TRUE(!node.visible || slow.visible[i] || slow.witnessed(i)) << slow.grid.position(i).transpose();
    counted += node.visible && !near ? 1 : 0;
    (node.visible ? seen : hidden) += 1;
  }
  EXPECT_EQ(fast.counted, counted);
  EXPECT_GT(fast.counted, 0U);
  EXPECT_GT(seen, 0U);
  EXPECT_GT(hidden, 0U);
}

TYPED_TEST(ReferenceOf, TwoRoomsMatchTheDefinition) {
  constexpr int Dim = TypeParam::value;
  for (const double gap : {7.7, 7.2, 6.6, 4.0})  // Shut, a slit to look through, a slit next to a node row, a door.
    expect_the_definition<Dim>(two_rooms<Dim>(gap), cube<Dim>(0.0, 8.0), place<Dim>(2.0, 2.0), coarse());
}

/// What shows through a slit of half a spacing is marked, what shows through a door of four of them is not.
TYPED_TEST(ReferenceOf, WhatShowsThroughASlitIsNarrow) {
  constexpr int Dim = TypeParam::value;
  for (const bool slit : {true, false}) {
    ReferenceOptions options = coarse();
    options.rays = 600;
    Mesh<Dim> mesh = two_rooms<Dim>(3.8);
    Box<Dim> above = cube<Dim>(0.3, 7.7);
    above.low.template head<2>() = Vec<2>(4.1, 4.2);
    if (slit) add_side(mesh, above, 0, false);
    const RayCaster<Dim> truth(mesh);
    const Reference<Dim> rooms = make_reference(truth, cube<Dim>(0.0, 8.0), place<Dim>(2.0, 2.0), options);
    std::size_t behind = 0, narrow = 0;
    for (std::size_t i = 0; i < rooms.nodes.values.size(); ++i) {
      const Truth node = rooms.nodes[i];
      EXPECT_TRUE(!node.narrow || (node.counts() && !node.reachable));
      narrow += node.narrow ? 1 : 0;
      if (rooms.nodes.window.position(i)[0] < 5.2 || !node.counts()) continue;
      ++behind;
      EXPECT_EQ(node.narrow, slit) << rooms.nodes.window.position(i).transpose();
    }
    EXPECT_GT(behind, 10U);
    EXPECT_EQ(rooms.narrow, narrow);
  }
}

TYPED_TEST(ReferenceOf, PillarsMatchTheDefinition) {
  constexpr int Dim = TypeParam::value;
  for (const double range : {80.0, 1.0}) {
    ReferenceOptions options = coarse();
    options.range = range;
    options.clearance = 0.75;
    expect_the_definition<Dim>(pillars<Dim>(), cube<Dim>(0.0, 8.0), place<Dim>(3.5, 3.0), options);
  }
}

TYPED_TEST(ReferenceOf, ThinWallBetweenNodesBlocks) {
  constexpr int Dim = TypeParam::value;
  ReferenceOptions options = coarse();
  options.clearance = 0.05;  // Nodes on both sides of the wall are clear of it.
  const RayCaster<Dim> truth(two_rooms<Dim>(7.7));
  const Reference<Dim> shut = make_reference(truth, cube<Dim>(0.0, 8.0), place<Dim>(2.0, 2.0), options);
  for (std::size_t i = 0; i < shut.nodes.values.size(); ++i) {
    const Vec<Dim> p = shut.nodes.window.position(i);
    EXPECT_EQ(shut.nodes[i].reachable, p[0] < 4.1 && cube<Dim>(0.3, 7.7).contains(p)) << p.transpose();
    EXPECT_EQ(shut.nodes[i].visible, shut.nodes[i].reachable) << p.transpose();
  }
}

TYPED_TEST(ReferenceOf, WallThroughNodesBlocks) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  Box<Dim> room = cube<Dim>(0.3, 7.7);
  add_box(mesh, room);
  room.low[0] = 4.0;
  add_side(mesh, room, 0, false);
  const RayCaster<Dim> truth(mesh);
  ReferenceOptions options = coarse();
  options.clearance = 0.0;
  const Reference<Dim> shut = make_reference(truth, cube<Dim>(0.0, 8.0), place<Dim>(2.0, 2.0), options);
  for (std::size_t i = 0; i < shut.nodes.values.size(); ++i)
    EXPECT_FALSE(shut.nodes.window.position(i)[0] > 4.0 && shut.nodes[i].visible) << shut.nodes.window.position(i).transpose();
}

TYPED_TEST(ReferenceOf, EmptyDomainIsReachableThroughout) {
  constexpr int Dim = TypeParam::value;
  const RayCaster<Dim> truth(Mesh<Dim>{});
  Box<Dim> domain = cube<Dim>(0.1, 6.1);
  const Reference<Dim> open = make_reference(truth, domain, place<Dim>(2.0, 3.0), coarse(0.5));
  std::size_t inside = 0;
  for (std::size_t i = 0; i < open.nodes.values.size(); ++i) inside += domain.contains(open.nodes.window.position(i)) ? 1 : 0;
  EXPECT_EQ(open.counted, inside);
  std::size_t expected = 1;
  for (int a = 0; a < Dim; ++a) expected *= 24;  // 0.25, 0.5 .. 6.0
  EXPECT_EQ(inside, expected);
  EXPECT_DOUBLE_EQ(open.volume(), static_cast<double>(expected) * std::pow(0.25, Dim));
}

TYPED_TEST(ReferenceOf, StartWithoutRoomIsRefused) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;
  add_box(mesh, cube<Dim>(3.6, 4.4));
  const RayCaster<Dim> truth(mesh);
  EXPECT_THROW((void)make_reference(truth, cube<Dim>(0.0, 8.0), place<Dim>(4.0, 4.0), coarse()), Error);  // In the box.
  EXPECT_THROW((void)make_reference(truth, cube<Dim>(0.0, 8.0), place<Dim>(9.0, 4.0), coarse()), Error);  // Outside.
  ReferenceOptions wrong = coarse();
  wrong.voxel = -1.0;
  EXPECT_THROW((void)make_reference(truth, cube<Dim>(0.0, 8.0), place<Dim>(2.0, 4.0), wrong), Error);
}

TYPED_TEST(ReferenceOf, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const RayCaster<Dim> truth(pillars<Dim>());
  const auto build = [&](int threads) {
    const ThreadLimit limit(threads);
    return make_reference(truth, cube<Dim>(0.0, 8.0), place<Dim>(3.5, 3.0), coarse(0.5));
  };
  const Reference<Dim> one = build(1);
  for (const int threads : {2, 7}) {
    const Reference<Dim> many = build(threads);
    ASSERT_EQ(many.nodes.values.size(), one.nodes.values.size());
    EXPECT_EQ(std::memcmp(many.nodes.values.data(), one.nodes.values.data(), one.nodes.values.size() * sizeof(Truth)), 0);
  }
}

TEST(FixedDirections, AreUnitAndEvenlySpread) {
  Vec<2> sum2 = Vec<2>::Zero();
  for (const Vec<2>& d : fixed_directions<2>(360)) {
    EXPECT_NEAR(d.norm(), 1.0, 1e-14);
    sum2 += d;
  }
  EXPECT_NEAR(sum2.norm(), 0.0, 1e-12);
  const auto sphere = fixed_directions<3>(1000);
  ASSERT_EQ(sphere.size(), 1000U);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Vec<3>& d : sphere) {
    EXPECT_NEAR(d.norm(), 1.0, 1e-14);
    moments += d * d.transpose() / 1000.0;
    double nearest = 4.0;
    for (const Vec<3>& other : sphere)
      if (&other != &d) nearest = std::min(nearest, (other - d).norm());
    EXPECT_GT(nearest, 0.07);  // 1,000 even caps: centres about 0.12 apart.
    EXPECT_LT(nearest, 0.15);
  }
  EXPECT_LT((moments - Eigen::Matrix3d::Identity() / 3.0).cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace vantage
