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
  static constexpr double kRange = 4.9;  // From here none of the borders was looked at.
  const Vec<Dim> here = on_axis<Dim>(-1.0);
  Planner<Dim> planner;
  Decision<Dim> decision;

  explicit Corridor(const StationRule<Dim>& rule = {}) : planner(clear(), kRange, 1) {
    planner.set_rule(rule);
    decision = planner.choose(belief.view(), here, 1.0);
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
  EXPECT_DOUBLE_EQ(ranked[0].added_volume, ranked[0].new_volume);
  EXPECT_NEAR(ranked[0].new_volume, corridor.decision.expected_volume, 0.2 * ranked[0].new_volume);
  for (std::size_t k = 1; k < ranked.size(); ++k) {
    EXPECT_LE(ranked[k].added_volume, ranked[k].new_volume * (1.0 + 1e-9));
    EXPECT_EQ(ranked[k].path.front(), corridor.here);
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
  const std::vector<Vec<Dim>> among{on_axis<Dim>(3.0)};
  const auto free = corridor.rank({.count = 1, .among = among});
  const auto rest = corridor.rank({.count = 1, .planned = {on_axis<Dim>(3.25)}, .among = among});
  const auto elsewhere = corridor.rank({.count = 1, .planned = {on_axis<Dim>(-5.0)}, .among = among});
  ASSERT_TRUE(free.size() == 1 && rest.size() == 1 && elsewhere.size() == 1);
  EXPECT_DOUBLE_EQ(free[0].added_volume, free[0].new_volume);
  EXPECT_DOUBLE_EQ(rest[0].new_volume, free[0].new_volume);
  EXPECT_LT(rest[0].added_volume, 0.8 * free[0].added_volume);  // Faces open with a chance of one half.
  EXPECT_GT(rest[0].added_volume, 0.2 * free[0].added_volume);
  EXPECT_NEAR(elsewhere[0].added_volume, free[0].added_volume, 1e-9);  // The other end.
  EXPECT_TRUE(corridor.rank({.count = 1, .apart = 1.0, .planned = {on_axis<Dim>(3.25)}, .among = among}).empty());
}

TYPED_TEST(RankTest, OverlapIsTheShareOfKnownSurfaceInView) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> corridor;
  const std::vector<Vec<Dim>> among{on_axis<Dim>(0.5), on_axis<Dim>(2.5)};
  const auto seen = corridor.rank({.count = 2, .among = among});
  ASSERT_EQ(seen.size(), 2U);
  const auto& [far, near] = seen[0].position[0] < 1.0 ? std::pair(seen[0], seen[1]) : std::pair(seen[1], seen[0]);
  EXPECT_LT(near.overlap, far.overlap - 0.03);
  EXPECT_LT(far.overlap, 1.0);
  const double least = 0.5 * (near.overlap + far.overlap);
  const auto kept = corridor.rank({.count = 2, .overlap = least, .among = among});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].position, far.position);
  EXPECT_TRUE(corridor.rank({.count = 2, .overlap = 1.0, .among = among}).empty());
}

TYPED_TEST(RankTest, WorthDirectsTheRankingButIsNoVolume) {
  constexpr int Dim = TypeParam::value;
  const Corridor<Dim> plain;
  EXPECT_GT(plain.decision.position[0], 0.0);  // The right end is larger.
  const Corridor<Dim> left({.places = {}, .worth = [](const Vec<Dim>& p) { return p[0] < -5.0 ? 10.0 : 1.0; }});
  EXPECT_LT(left.decision.position[0], -1.0);
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
