// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/ground.h"

#include <gtest/gtest.h>

#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class GroundTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(GroundTest, Dimensions);

constexpr double kH = kTestSpacing;
constexpr GroundOptions kWalker{1.5, 0.3, 0.2, 0.6};

/// Free above `height_at`, ground at and below it.
template <int Dim, class HeightAt>
HandMade<Dim> land(HeightAt&& height_at) {
  return HandMade<Dim>(cube<Dim>(4.0), [&](const Vec<Dim>& p) { return p[Dim - 1] <= height_at(p) + 1e-9 ? NodeState::obstacle : NodeState::seen; });
}

template <int Dim>
Vec<Dim> above(double x, double up) {
  Vec<Dim> p = on_axis<Dim>(x);
  p[Dim - 1] = up;
  return p;
}

template <int Dim>
double height_of(const BeliefView<Dim>& view, const Vec<Dim>& place) {
  return heights_above_ground<Dim>(view, std::array{place}, 6.0)[0];
}

/// Along the first axis: from where to where there are walkable nodes [m].
template <int Dim>
std::array<double, 2> reach(const Field<Dim, std::uint8_t>& nodes) {
  std::array<double, 2> ends{kInfinity, -kInfinity};
  for (std::size_t i = 0; i < nodes.values.size(); ++i) {
    if (nodes[i] == 0) continue;
    ends[0] = std::min(ends[0], nodes.window.position(i)[0]);
    ends[1] = std::max(ends[1], nodes.window.position(i)[0]);
  }
  return ends;
}

TYPED_TEST(GroundTest, LevelGroundIsWalkableAtTheHeight) {
  constexpr int Dim = TypeParam::value;
  const auto belief = land<Dim>([](const Vec<Dim>&) { return 0.0; });
  EXPECT_NEAR(height_of<Dim>(belief.view(), above<Dim>(0.0, 1.37)), 1.37, 1e-6);
  const auto nodes = walkable_nodes<Dim>(belief.view(), above<Dim>(0.0, 1.5), kWalker);
  for (std::size_t i = 0; i < nodes.values.size(); ++i)
    ASSERT_EQ(nodes[i] != 0, std::abs(nodes.window.position(i)[Dim - 1] - 1.5) < 1e-9) << nodes.window.position(i).transpose();
}

TYPED_TEST(GroundTest, GroundIsFoundBelowWhatIsSeenDownToIt) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> belief(cube<Dim>(4.0), [](const Vec<Dim>& p) {
    if (p[Dim - 1] <= -0.9) return NodeState::obstacle;
    return p[0] > 0.9 && p[Dim - 1] < 1.0 ? NodeState::unseen : NodeState::seen;
  });
  EXPECT_NEAR(ground_below<Dim>(belief.view(), above<Dim>(0.0, 2.0)), -1.0, 1e-6);
  EXPECT_NEAR(ground_below<Dim>(belief.view(), above<Dim>(0.1, -0.7)), -1.0, 1e-6);
  EXPECT_EQ(ground_below<Dim>(belief.view(), above<Dim>(2.0, 2.0)), -kInfinity);   // Not seen all the way down.
  EXPECT_EQ(ground_below<Dim>(belief.view(), above<Dim>(0.0, -2.0)), -kInfinity);  // Below it.
  EXPECT_EQ(ground_below<Dim>(belief.view(), above<Dim>(9.0, 2.0)), -kInfinity);
}

TYPED_TEST(GroundTest, SlopesUpToTheSteepestAreWalked) {
  constexpr int Dim = TypeParam::value;
  const auto belief = land<Dim>([](const Vec<Dim>& p) { return std::clamp(p[0], 0.0, 2.0); });  // 45 degrees: a cell a column.
  const auto walk = [&](double slope, double step) {
    GroundOptions options = kWalker;
    options.slope = slope;
    options.step = step;
    return reach<Dim>(walkable_nodes<Dim>(belief.view(), above<Dim>(-2.0, 1.5), options));
  };
  EXPECT_EQ(walk(1.01, 0.0), (std::array{-4.0, 4.0}));
  EXPECT_EQ(walk(0.99, 0.0), (std::array{-4.0, 0.0}));
  EXPECT_EQ(walk(0.5, 1.01 * kH), (std::array{-4.0, 4.0}));  // As stairs.
}

TYPED_TEST(GroundTest, StepsUpToTheHighestAreWalked) {
  constexpr int Dim = TypeParam::value;
  const auto belief = land<Dim>([](const Vec<Dim>& p) { return p[0] > 0.9 ? 0.5 : 0.0; });
  const auto walk = [&](double from, double step) {
    GroundOptions options = kWalker;
    options.step = step;
    return reach<Dim>(walkable_nodes<Dim>(belief.view(), above<Dim>(from, from > 0.0 ? 2.0 : 1.5), options));
  };
  EXPECT_EQ(walk(-2.0, 0.51), (std::array{-4.0, 4.0}));
  EXPECT_EQ(walk(-2.0, 0.49), (std::array{-4.0, 0.75}));
  EXPECT_EQ(walk(3.0, 0.49), (std::array{1.0, 4.0}));  // Nor down again.
}

TYPED_TEST(GroundTest, ClearanceIsKept) {
  constexpr int Dim = TypeParam::value;
  const auto belief = land<Dim>([](const Vec<Dim>& p) { return p[0] > 0.9 ? 9.0 : 0.0; });  // A wall, from x = 1 on.
  for (const double clearance : {0.3, 0.6, 1.0}) {
    GroundOptions options = kWalker;
    options.clearance = clearance;
    const auto nodes = walkable_nodes<Dim>(belief.view(), above<Dim>(-2.0, 1.5), options);
    const double last = std::floor((1.0 - clearance + 0.5 * kH) / kH) * kH;  // Half a cell of grace.
    EXPECT_EQ(reach<Dim>(nodes), (std::array{-4.0, last})) << clearance;
  }
  // Under a roof that leaves room for the scanner only: its own height counts for what is below, the clearance above.
  const HandMade<Dim> low(cube<Dim>(4.0), [](const Vec<Dim>& p) {
    return p[Dim - 1] <= 1e-9 || p[Dim - 1] > (p[0] > 0.1 ? 1.6 : 3.1) ? NodeState::obstacle : NodeState::seen;
  });
  GroundOptions options = kWalker;
  options.clearance = 0.6;
  EXPECT_LT(reach<Dim>(walkable_nodes<Dim>(low.view(), above<Dim>(-2.0, 1.5), options))[1], 0.3);
  options.clearance = 0.3;
  EXPECT_EQ(reach<Dim>(walkable_nodes<Dim>(low.view(), above<Dim>(-2.0, 1.5), options))[1], 4.0);
}

TYPED_TEST(GroundTest, WhatIsClosedIsNotWalkedThrough) {
  constexpr int Dim = TypeParam::value;
  const auto belief = land<Dim>([](const Vec<Dim>&) { return 0.0; });
  const auto closed = [](const Vec<Dim>& p) { return std::abs(p[0] - 1.0) < 0.2; };
  EXPECT_EQ(reach<Dim>(walkable_nodes<Dim>(belief.view(), above<Dim>(-2.0, 1.5), kWalker, closed)), (std::array{-4.0, 0.75}));
  const auto high = [](const Vec<Dim>& p) { return p[Dim - 1] > 2.0; };
  EXPECT_EQ(reach<Dim>(walkable_nodes<Dim>(belief.view(), above<Dim>(-2.0, 1.5), kWalker, high)), (std::array{-4.0, 4.0}));
}

TYPED_TEST(GroundTest, UnseenAndMissingGroundAreNotWalked) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> hidden(cube<Dim>(4.0), [](const Vec<Dim>& p) {
    if (p[Dim - 1] <= 1e-9) return NodeState::obstacle;
    return p[0] > 0.9 && p[Dim - 1] < 1.0 ? NodeState::unseen : NodeState::seen;  // Seen above, not below.
  });
  EXPECT_EQ(reach<Dim>(walkable_nodes<Dim>(hidden.view(), above<Dim>(-2.0, 1.5), kWalker)), (std::array{-4.0, 0.75}));
  const HandMade<Dim> sky(cube<Dim>(4.0), [](const Vec<Dim>&) { return NodeState::seen; });
  EXPECT_EQ(reach<Dim>(walkable_nodes<Dim>(sky.view(), above<Dim>(0.0, 1.5), kWalker))[0], kInfinity);
  EXPECT_EQ(height_of<Dim>(sky.view(), above<Dim>(0.0, 1.5)), kInfinity);
}

TYPED_TEST(GroundTest, HeightIsTheMedianAroundWhereNothingIsSeenStraightBelow) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> belief(cube<Dim>(4.0), [](const Vec<Dim>& p) {
    const double ground = p[0] < -3.0 ? 1.0 : 0.0;  // A few columns are higher.
    if (std::abs(p[0]) < 1.1) return p[Dim - 1] <= 1e-9 ? NodeState::obstacle : p[Dim - 1] < 1.0 ? NodeState::unseen : NodeState::seen;
    return p[Dim - 1] <= ground + 1e-9 ? NodeState::obstacle : NodeState::seen;
  });
  EXPECT_NEAR(height_of<Dim>(belief.view(), above<Dim>(0.0, 1.6)), 1.6, 1e-6);
}

TYPED_TEST(GroundTest, WhoStandsBesideABenchIsNotOnIt) {
  constexpr int Dim = TypeParam::value;
  const auto belief = land<Dim>([](const Vec<Dim>& p) { return std::abs(p[0]) < 0.3 ? 0.5 : 0.0; });
  for (const double x : {-0.5, -0.25}) {  // The nearest column is the floor's, and the bench's.
    const Vec<Dim> here = above<Dim>(x, 1.6);
    EXPECT_NEAR(height_of<Dim>(belief.view(), here), 1.6, 1e-6) << x;
    GroundOptions options = kWalker;
    options.height = 1.6;
    EXPECT_EQ(reach<Dim>(walkable_nodes<Dim>(belief.view(), here, options))[0], -4.0) << x;
    const auto narrow = [](const Vec<Dim>& p) { return p[0] > -1.3 && p[0] < -0.3; };  // Nobody may stand right below.
    const auto [left, right] = reach<Dim>(walkable_nodes<Dim>(belief.view(), here, options, narrow));
    EXPECT_GT(right - left, 1.0) << x;
  }
  const auto stage = land<Dim>([](const Vec<Dim>& p) { return p[0] > 0.1 ? 0.5 : 0.0; });
  EXPECT_NEAR(height_of<Dim>(stage.view(), above<Dim>(1.5, 2.1)), 1.6, 1e-6);
}

}  // namespace
}  // namespace vantage
