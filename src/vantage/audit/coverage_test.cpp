// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/coverage.h"

#include <gtest/gtest.h>

#include <functional>
#include <type_traits>

#include "vantage/audit/test_scenes.h"
#include "vantage/base/error.h"

namespace vantage {
namespace {

using namespace test;

template <class Dimension>
class CoverageOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CoverageOf, Dimensions);

template <int Dim>
struct Explored {
  Explored() : truth(two_rooms<Dim>(4.0)) {
    ReferenceOptions options;
    options.clearance = 0.6;
    options.rays = 200;
    reference = make_reference(truth, domain, place<Dim>(2.0, 2.0), options);
    map = Field<Dim, NodeState>(window_over(domain, 0.5), NodeState::unseen);
  }
  /// Calls seen what the truth calls visible and no explorer could take for an obstacle.
  void see(const std::function<bool(const Vec<Dim>&)>& where) {
    for (std::size_t i = 0; i < map.values.size(); ++i) {
      const Truth node = reference.nodes.at(2 * (map.window.local(i) + map.window.first) - reference.nodes.window.first);
      if (node.visible && !node.blurred && where(map.window.position(i))) map[i] = NodeState::seen;
    }
  }

  Box<Dim> domain = cube<Dim>(0.0, 8.0);
  RayCaster<Dim> truth;
  Reference<Dim> reference;
  Field<Dim, NodeState> map;
};

TYPED_TEST(CoverageOf, PerfectMapCoversAllAndAnEmptyOneNothing) {
  constexpr int Dim = TypeParam::value;
  Explored<Dim> e;
  EXPECT_EQ(coverage(e.reference, e.map).fraction, 0.0);
  EXPECT_EQ(coverage(e.reference, e.map).falsely_free, 0.0);
  e.see([](const Vec<Dim>&) { return true; });
  EXPECT_EQ(coverage(e.reference, e.map).fraction, 1.0);
  EXPECT_EQ(coverage(e.reference, e.map).falsely_free, 0.0);
}

TYPED_TEST(CoverageOf, ExplorerThatKeepsOffSurfacesCoversAllTheSame) {
  constexpr int Dim = TypeParam::value;
  Explored<Dim> e;
  e.see([&](const Vec<Dim>& p) { return e.truth.distance(p) > 0.5; });
  EXPECT_EQ(coverage(e.reference, e.map).fraction, 1.0);
}

TYPED_TEST(CoverageOf, PartOfTheMapCoversItsShare) {
  constexpr int Dim = TypeParam::value;
  Explored<Dim> e;
  e.see([](const Vec<Dim>& p) { return p[1] < 3.9; });
  std::size_t expected = 0;
  for (std::size_t i = 0; i < e.reference.nodes.values.size(); ++i)
    expected += e.reference.nodes[i].counts() && e.reference.nodes.window.position(i)[1] < 3.9 ? 1 : 0;
  // The row between the last seen and the first unseen nodes, at 3.75, goes to the lower, seen side.
  EXPECT_DOUBLE_EQ(coverage(e.reference, e.map).fraction, static_cast<double>(expected) / static_cast<double>(e.reference.counted));
  EXPECT_GT(expected, 0U);
}

/// A map that lacks nothing but what shows through something narrow lacks nothing widely; with that, nothing at all.
TYPED_TEST(CoverageOf, WhatShowsThroughSlitsIsCountedApart) {
  constexpr int Dim = TypeParam::value;
  Explored<Dim> e;
  std::size_t narrow = 0;
  for (std::size_t i = 0; i < e.reference.nodes.values.size(); ++i) {
    Truth& node = e.reference.nodes[i];
    node.narrow = node.counts() && e.reference.nodes.window.position(i)[1] > 3.9;
    narrow += node.narrow ? 1 : 0;
  }
  e.reference.narrow = narrow;
  e.see([](const Vec<Dim>& p) { return p[1] < 3.9; });
  const Coverage half = coverage(e.reference, e.map);
  EXPECT_EQ(half.widely, 1.0);
  EXPECT_LT(half.fraction, 0.7);
  e.see([](const Vec<Dim>&) { return true; });
  EXPECT_EQ(coverage(e.reference, e.map).widely, 1.0);
  EXPECT_EQ(coverage(e.reference, e.map).fraction, 1.0);
}

TYPED_TEST(CoverageOf, SeenBehindAWallIsFalselyFree) {
  constexpr int Dim = TypeParam::value;
  Explored<Dim> e;
  e.see([](const Vec<Dim>&) { return true; });
  const Index<Dim> corner = Index<Dim>::Zero() - e.map.window.first;  // At the origin, outside the room.
  e.map.at(corner) = NodeState::seen;
  EXPECT_DOUBLE_EQ(coverage(e.reference, e.map).falsely_free, std::pow(0.5, Dim));
  e.map.at(corner) = NodeState::obstacle;
  EXPECT_EQ(coverage(e.reference, e.map).falsely_free, 0.0);
}

TYPED_TEST(CoverageOf, WindowOfTheMapMayDiffer) {
  constexpr int Dim = TypeParam::value;
  Explored<Dim> e;
  e.see([](const Vec<Dim>& p) { return p[0] < 3.0; });
  Field<Dim, NodeState> larger(padded(e.map.window, 3), NodeState::unseen);
  for (std::size_t i = 0; i < e.map.values.size(); ++i) larger.at(e.map.window.local(i).array() + 3) = e.map[i];
  EXPECT_EQ(coverage(e.reference, larger).fraction, coverage(e.reference, e.map).fraction);
  EXPECT_THROW((void)coverage(e.reference, Field<Dim, NodeState>(window_over(e.domain, 0.25))), Error);
}

/// A sight of the truth that the map does not know is falsely hidden; what no scan had in sight is not.
TYPED_TEST(CoverageOf, InSightButNotSeenIsFalselyHidden) {
  constexpr int Dim = TypeParam::value;
  Explored<Dim> e;
  const std::vector<Vec<Dim>> scans{place<Dim>(2.0, 2.0)};
  std::size_t in_view = 0;
  for (std::size_t i = 0; i < e.reference.nodes.values.size(); ++i)
    in_view += e.reference.nodes[i].counts() && in_sight(e.truth, scans[0], e.reference.nodes.window.position(i)) ? 1 : 0;
  ASSERT_LT(in_view, e.reference.counted);
  const auto hidden = [&](std::size_t nodes) { return falsely_hidden<Dim>(e.reference, e.truth, e.map, scans, nodes); };
  const double expected = static_cast<double>(in_view) * e.reference.node_volume();
  EXPECT_NEAR(hidden(e.reference.counted), expected, 1e-9);
  EXPECT_NEAR(hidden(1000), expected, 0.1 * expected);
  e.see([](const Vec<Dim>&) { return true; });
  EXPECT_EQ(hidden(1000), 0.0);
  EXPECT_EQ(falsely_hidden<Dim>(e.reference, e.truth, Field<Dim, NodeState>(e.map.window, NodeState::unseen), {}), 0.0);
}

}  // namespace
}  // namespace vantage
