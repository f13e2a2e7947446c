// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vantage/geometry/angle.h"
#include "vantage/planner/planner.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class RankTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RankTest, Dimensions);

constexpr double kH = kTestSpacing;

/// A corridor along the first axis, unseen at its ends: 2 m on the left, 4 m on the right. All that is known of it, and a planner that has decided.
template <int Dim>
struct Corridor {
  HandMade<Dim> belief{cube<Dim>(8.0), [](const Vec<Dim>& p) {
                         for (int a = 1; a < Dim; ++a)
                           if (std::abs(p[a]) > 1.5) return NodeState::obstacle;
                         return p[0] < -6.0 || p[0] > 4.0 ? NodeState::unseen : NodeState::seen;
                       }};
  Planner<Dim> planner;
  Decision<Dim> decision;

  explicit Corridor(const StationRule<Dim>& rule = {}) : planner(clear(), 80.0, 1) {
    planner.set_rule(rule);
    decision = planner.choose(belief.view(), on_axis<Dim>(-2.0), 1.0);
  }
  static PlannerOptions clear() {
    PlannerOptions options;
    options.lambda_factor = 0.0;
    return options;
  }
  [[nodiscard]] std::vector<RankedPlace<Dim>> rank(const RankRequest<Dim>& request) const { return planner.rank(belief.view(), request); }
};

TYPED_TEST(RankTest, TheDecisionIsFirstAndEachNextShowsWhatIsLeft) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> corridor;
  const auto ranked = corridor.rank({.count = 4, .apart = 1.0});
  ASSERT_GE(ranked.size(), 2U);
  EXPECT_EQ(ranked[0].position, corridor.decision.position);
  EXPECT_EQ(ranked[0].added_volume, ranked[0].new_volume);
  EXPECT_NEAR(ranked[0].new_volume, corridor.decision.expected_volume, 0.05 * ranked[0].new_volume);
  for (std::size_t k = 1; k < ranked.size(); ++k) {
    EXPECT_LT(ranked[k].added_volume, ranked[k].new_volume);
    EXPECT_EQ(ranked[k].path.front(), on_axis<Dim>(-2.0));
    EXPECT_EQ(ranked[k].path.back(), ranked[k].position);
    for (std::size_t i = 0; i < k; ++i) EXPECT_GE((ranked[k].position - ranked[i].position).norm(), 1.0);
  }
}

TYPED_TEST(RankTest, PlacesKeepApart) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> corridor;
  const auto near = corridor.rank({.count = 50, .apart = 0.5}), far = corridor.rank({.count = 50, .apart = 6.0});
  EXPECT_GT(near.size(), far.size());
  EXPECT_LE(far.size(), 2U);  // The corridor is 10 m long.
  EXPECT_EQ(far[0].position, near[0].position);
}

TYPED_TEST(RankTest, WhatPlannedStationsShowIsNotCountedAgain) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> corridor;
  const auto free = corridor.rank({.count = 1});
  const auto rest = corridor.rank({.count = 1, .apart = 1.0, .planned = {free[0].position}});
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_GE((rest[0].position - free[0].position).norm(), 1.0);
  EXPECT_LT(rest[0].added_volume, 0.5 * free[0].new_volume);
  // Both ends have been planned for: nothing is left to show but what the two do not see for certain.
  const auto none = corridor.rank({.count = 1, .apart = 1.0, .planned = {on_axis<Dim>(3.5), on_axis<Dim>(-5.5), on_axis<Dim>(-1.0)}});
  EXPECT_LT(none.empty() ? 0.0 : none[0].added_volume, 0.2 * free[0].new_volume);
}

TYPED_TEST(RankTest, OverlapIsTheShareOfKnownSurfaceInView) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> corridor;
  const auto seen = corridor.rank({.count = 2, .among = {on_axis<Dim>(-1.0), on_axis<Dim>(3.5)}});
  ASSERT_EQ(seen.size(), 2U);
  const auto& [middle, end] = seen[0].position[0] < 0.0 ? std::pair(seen[0], seen[1]) : std::pair(seen[1], seen[0]);
  // From the middle, the open ends are 5 m off and half as wide as high: the rest of the circle or sphere is wall.
  const double half = 1.5 + 0.5 * kH;
  const std::array<double, 2> open{2.0 * std::atan(half / 5.0) / kPi, 2.0 * std::atan(half * half / (5.0 * std::sqrt(25.0 + 2.0 * half * half))) * 4.0 / (4.0 * kPi)};
  EXPECT_NEAR(middle.overlap, 1.0 - open[Dim - 2], 0.03);
  EXPECT_LT(end.overlap, middle.overlap - 0.1);
  const double least = 0.5 * (middle.overlap + end.overlap);
  const auto kept = corridor.rank({.count = 2, .overlap = least, .among = {on_axis<Dim>(-1.0), on_axis<Dim>(3.5)}});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].position, middle.position);
  EXPECT_TRUE(corridor.rank({.count = 2, .overlap = 1.0, .among = {on_axis<Dim>(3.5)}}).empty());
}

TYPED_TEST(RankTest, WorthDirectsTheRankingButIsNoVolume) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> plain;
  EXPECT_GT(plain.decision.position[0], 0.0);  // The right end is larger.
  const Corridor<Dim> left({.places = {}, .worth = [](const Vec<Dim>& p) { return p[0] < -5.0 ? 10.0 : 1.0; }});
  EXPECT_LT(left.decision.position[0], -2.0);
  const auto ranked = left.rank({.count = 3, .apart = 1.0});
  double end = 2.0;  // Of the left end.
  for (int a = 1; a < Dim; ++a) end *= 3.0 + kH;
  for (const RankedPlace<Dim>& place : ranked) EXPECT_LE(place.added_volume, place.new_volume * (1.0 + 1e-9));
  EXPECT_LT(ranked[0].new_volume, 3.5 * end);  // Of both ends, not ten times the left one.
}

/// Faces are met frontally from afar and flatly from beside them.
TYPED_TEST(RankTest, FlatLooksShowNothing) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> corridor;
  const std::vector<Vec<Dim>> among{on_axis<Dim>(3.5)};
  const double all = corridor.rank({.count = 1, .among = among}).at(0).new_area;
  double last = all;
  for (const double limit : {80.0, 60.0, 40.0}) {
    const auto ranked = corridor.rank({.count = 1, .among = among, .least_cosine = sin_cos(radians(limit))[1]});
    ASSERT_EQ(ranked.size(), 1U);
    EXPECT_LE(ranked[0].new_area, last);
    last = ranked[0].new_area;
  }
  EXPECT_LT(last, 0.8 * all);
  // At 60 degrees a place 0.6 m before the border sees no more of it than 0.6 sqrt(3) to each side.
}

TYPED_TEST(RankTest, BadlySeenSurfaceDrawsStations) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> corridor;
  SurfacePiece<Dim> piece;
  piece.center = on_axis<Dim>(-4.0);
  piece.center[1] = 1.5 + 0.5 * kH;
  piece.normal = Vec<Dim>::Unit(1);
  piece.area = 5.0;
  RankRequest<Dim> request{.count = 1, .apart = 1.0, .least_cosine = sin_cos(radians(30.0))[1], .mend = {piece}};
  request.among = {on_axis<Dim>(-4.0), on_axis<Dim>(-2.0)};
  const auto ranked = corridor.rank(request);
  ASSERT_EQ(ranked.size(), 1U);
  EXPECT_EQ(ranked[0].position, request.among[0]);  // It faces the piece; the other one is more than 30 degrees off.
  EXPECT_EQ(ranked[0].mended, piece.area);
  request.count = 2;
  EXPECT_EQ(corridor.rank(request).back().mended, 0.0);
  request.mend[0].area = 0.0;
}

}  // namespace
}  // namespace vantage
