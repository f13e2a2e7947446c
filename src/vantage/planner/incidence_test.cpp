// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/incidence.h"

#include <gtest/gtest.h>

#include "vantage/geometry/angle.h"

namespace vantage {
namespace {

template <class T>
class IncidenceTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(IncidenceTest, Dimensions);

constexpr double kLong = 10.0, kHalf = 1.0;

/// A wall at y = 0, from x = 0 to 10; in space 2 m high, about z = 0.
Patch<2> wall(const Vec<2>*) { return segment_patch<2>({0, 0}, {kLong, 0}); }
Patch<3> wall(const Vec<3>*) {
  Patch<3> patch;
  patch.count = 4;
  patch.vertices[0] = {0, 0, -kHalf};
  patch.vertices[1] = {kLong, 0, -kHalf};
  patch.vertices[2] = {kLong, 0, kHalf};
  patch.vertices[3] = {0, 0, kHalf};
  return patch;
}
template <int Dim>
Patch<Dim> wall() {
  return wall(static_cast<const Vec<Dim>*>(nullptr));
}

/// A scan of the infinite wall y = 0 from a place with y > 0.
template <int Dim>
Scan<Dim> scan_from(const Vec<Dim>& place, double step = 1.0) {
  Scan<Dim> scan;
  scan.origin = place;
  scan.pattern.step = radians(step);
  for (const Vec<Dim>& d : directions<Dim>(scan.pattern)) {
    const double range = d[1] < 0.0 ? place[1] / -d[1] : kInfinity;
    scan.ranges.push_back(range < scan.pattern.max_range ? static_cast<float>(range) : kNoReturn);
  }
  return scan;
}

template <int Dim>
Incidence<Dim> of_wall() {
  const std::vector<Patch<Dim>> patches{wall<Dim>()};
  return Incidence<Dim>(patches, window_over(Box<Dim>{Vec<Dim>::Constant(-2.0), Vec<Dim>::Constant(11.0)}, 0.25));
}

/// Area of the wall within a limit of a place 1 m before its beginning, at z = 0: what is at most tan(limit) m off.
double within(double limit, std::integral_constant<int, 2>) { return std::tan(radians(limit)); }
double within(double limit, std::integral_constant<int, 3>) {
  const double r = std::tan(radians(limit)), a = std::min(r, kHalf);  // Half a disc cut to +- kHalf.
  return a * std::sqrt(r * r - a * a) + r * r * std::asin(a / r);
}

TYPED_TEST(IncidenceTest, TheFlatPartOfAWallIsAsLargeAsItMustBe) {
  constexpr int Dim = TypeParam::value;
  auto incidence = of_wall<Dim>();
  Vec<Dim> place = Vec<Dim>::Zero();
  place[1] = 1.0;
  incidence.add(scan_from<Dim>(place));
  const double all = measure(wall<Dim>());
  for (const double limit : {40.0, 60.0, 75.0}) {
    const FlatSurface<Dim> flat = incidence.flatter(sin_cos(radians(limit))[1]);
    EXPECT_NEAR(flat.area, all - within(limit, TypeParam{}), 0.15) << limit;
    ASSERT_EQ(flat.regions.size(), 1U);
    EXPECT_NEAR(flat.regions[0].area, flat.area, 1e-9);
    EXPECT_NEAR(flat.regions[0].box.high[0], kLong, 0.2);
    EXPECT_GT(flat.regions[0].incidence, radians(limit));
    EXPECT_LT(flat.regions[0].incidence, angle_of(kLong, 1.0));
  }
  EXPECT_EQ(incidence.flatter(0.0).area, 0.0);
}

TYPED_TEST(IncidenceTest, ABetterLookMends) {
  constexpr int Dim = TypeParam::value;
  auto incidence = of_wall<Dim>();
  Vec<Dim> place = Vec<Dim>::Zero();
  place[1] = 1.0;
  incidence.add(scan_from<Dim>(place));
  const double limit = sin_cos(radians(60.0))[1], before = incidence.flatter(limit).area;
  place[0] = 8.0;
  place[1] = 2.0;
  incidence.add(scan_from<Dim>(place));
  const FlatSurface<Dim> after = incidence.flatter(limit);
  EXPECT_LT(after.area, 0.5 * before);
  for (const SurfacePiece<Dim>& piece : after.pieces) EXPECT_LT(piece.center[0], 8.0 - 2.0);
  place[1] = 0.2;
  incidence.add(scan_from<Dim>(place));  // A worse look takes nothing back.
  EXPECT_LE(incidence.flatter(limit).area, after.area);
}

TYPED_TEST(IncidenceTest, WhatNoRayMetWasNotLookedAt) {
  constexpr int Dim = TypeParam::value;
  auto incidence = of_wall<Dim>();
  Vec<Dim> place = Vec<Dim>::Zero();
  place[1] = 1.0;
  Scan<Dim> blocked = scan_from<Dim>(place);
  for (float& range : blocked.ranges) range = std::isfinite(range) ? std::min(range, 0.5F) : range;  // Something round the scanner.
  incidence.add(blocked);
  EXPECT_EQ(incidence.flatter(1.1).area, 0.0);
  incidence.add(scan_from<Dim>(place));
  EXPECT_NEAR(incidence.flatter(1.1).area, measure(wall<Dim>()), 1e-9);
}

TEST(IncidenceTests, PointsAndThinPiecesHaveNoSide) {
  const std::vector<Patch<3>> patches{point_patch<3>({1, 1, 1}), segment_patch<3>({0, 0, 0}, {5, 0, 0})};
  Incidence<3> incidence(patches, window_over(Box<3>{{-2, -2, -2}, {8, 8, 8}}, 0.25));
  incidence.add(scan_from<3>({1, 2, 0}));
  EXPECT_EQ(incidence.flatter(1.1).area, 0.0);
}

}  // namespace
}  // namespace vantage
