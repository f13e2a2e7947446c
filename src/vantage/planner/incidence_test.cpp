// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/incidence.h"

#include <gtest/gtest.h>

#include "vantage/geometry/angle.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class IncidenceTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(IncidenceTest, Dimensions);

constexpr double kLong = 10.0, kHalf = 1.0, kH = kTestSpacing;

/// Free space before a wall at y = 0, from x = 0 to 10; in space 2 m high, about z = 0.
template <int Dim>
HandMade<Dim> wall() {
  Box<Dim> box{Vec<Dim>::Constant(-kHalf), Vec<Dim>::Constant(kHalf)};
  box.low[0] = 0.0, box.high[0] = kLong, box.high[1] = 3.0;
  return HandMade<Dim>(box, [](const Vec<Dim>& p) { return p[1] < 0.1 ? NodeState::obstacle : NodeState::seen; });
}

/// Its area: a face of a cell before every node of it.
template <int Dim>
double wall_area() {
  double area = kLong + kH;
  for (int a = 2; a < Dim; ++a) area *= 2.0 * kHalf + kH;
  return area;
}

/// A scan of the infinite wall y = h / 2 from a place before it.
template <int Dim>
Scan<Dim> scan_from(const Vec<Dim>& place, double step = 1.0) {
  Scan<Dim> scan;
  scan.origin = place;
  scan.pattern.step = radians(step);
  for (const Vec<Dim>& d : directions<Dim>(scan.pattern)) {
    const double range = d[1] < 0.0 ? (place[1] - 0.5 * kH) / -d[1] : kInfinity;
    scan.ranges.push_back(range < scan.pattern.max_range ? static_cast<float>(range) : kNoReturn);
  }
  return scan;
}

/// Area of the wall within a limit of a place 1 m before its beginning, at z = 0: what is at most tan(limit) m off.
double within(double limit, std::integral_constant<int, 2>) { return std::tan(radians(limit)); }
double within(double limit, std::integral_constant<int, 3>) {
  const double r = std::tan(radians(limit)), a = std::min(r, kHalf + 0.5 * kH);  // Half a disc cut off above and below.
  return a * std::sqrt(r * r - a * a) + r * r * std::asin(a / r);
}

/// 1 m before the wall's beginning, and so far along it.
template <int Dim>
Vec<Dim> before(double x, double off = 1.0) {
  Vec<Dim> p = Vec<Dim>::Zero();
  p[0] = x;
  p[1] = off + 0.5 * kH;
  return p;
}

TYPED_TEST(IncidenceTest, TheFlatPartOfAWallIsAsLargeAsItMustBe) {
  constexpr int Dim = TypeParam::value;
  const auto belief = wall<Dim>();
  Incidence<Dim> incidence(belief.view());
  incidence.add(scan_from<Dim>(before<Dim>(0.0)));
  for (const double limit : {40.0, 60.0, 75.0}) {
    const FlatSurface<Dim> flat = incidence.flatter(sin_cos(radians(limit))[1]);
    EXPECT_NEAR(flat.area, wall_area<Dim>() - within(limit, TypeParam{}), 0.06 * wall_area<Dim>()) << limit;
    ASSERT_EQ(flat.regions.size(), 1U);
    EXPECT_NEAR(flat.regions[0].area, flat.area, 1e-9);
    EXPECT_NEAR(flat.regions[0].box.high[0], kLong, 1e-9);
    EXPECT_GT(flat.regions[0].incidence, radians(limit));
    EXPECT_LT(flat.regions[0].incidence, angle_of(kLong, 1.0));
  }
  EXPECT_EQ(incidence.flatter(0.0).area, 0.0);
}

TYPED_TEST(IncidenceTest, ABetterLookMends) {
  constexpr int Dim = TypeParam::value;
  const auto belief = wall<Dim>();
  Incidence<Dim> incidence(belief.view());
  incidence.add(scan_from<Dim>(before<Dim>(0.0)));
  const double limit = sin_cos(radians(60.0))[1], at_first = incidence.flatter(limit).area;
  incidence.add(scan_from<Dim>(before<Dim>(8.0, 2.0)));
  const FlatSurface<Dim> after = incidence.flatter(limit);
  EXPECT_LT(after.area, 0.5 * at_first);
  for (const SurfacePiece<Dim>& piece : after.pieces) EXPECT_LT(piece.center[0], 8.0 - 2.0);
  incidence.add(scan_from<Dim>(before<Dim>(8.0, 0.2)));  // A worse look takes nothing back.
  EXPECT_LE(incidence.flatter(limit).area, after.area);
}

TYPED_TEST(IncidenceTest, WhatNoRayMetWasNotLookedAt) {
  constexpr int Dim = TypeParam::value;
  const auto belief = wall<Dim>();
  Incidence<Dim> incidence(belief.view());
  Scan<Dim> blocked = scan_from<Dim>(before<Dim>(5.0));
  for (float& range : blocked.ranges) range = std::isfinite(range) ? std::min(range, 0.4F) : range;  // Something round the scanner.
  incidence.add(blocked);
  EXPECT_EQ(incidence.flatter(1.1).area, 0.0);
  incidence.add(scan_from<Dim>(before<Dim>(5.0)));
  EXPECT_NEAR(incidence.flatter(1.1).area, wall_area<Dim>(), 1e-9);
}

/// A wall at 45 degrees: its area and normal are those of the plane, not of the stairs.
TYPED_TEST(IncidenceTest, SlantedWallsHaveTheirOwnNormals) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> belief(cube<Dim>(3.0), [](const Vec<Dim>& p) { return p[0] + p[1] < 0.05 ? NodeState::obstacle : NodeState::seen; });
  Incidence<Dim> incidence(belief.view());
  Scan<Dim> scan;
  scan.origin[0] = scan.origin[1] = 1.5;
  scan.pattern.step = radians(1.0);
  for (const Vec<Dim>& d : directions<Dim>(scan.pattern)) {
    const double range = d[0] + d[1] < 0.0 ? (3.0 - 0.5 * kH) / -(d[0] + d[1]) : kInfinity;
    scan.ranges.push_back(range < 20.0 ? static_cast<float>(range) : kNoReturn);
  }
  incidence.add(scan);
  const FlatSurface<Dim> all = incidence.flatter(1.1);
  double area = 6.0 * std::sqrt(2.0);
  for (int a = 2; a < Dim; ++a) area *= 6.0 + kH;
  EXPECT_NEAR(all.area, area, 0.08 * area);
  for (const SurfacePiece<Dim>& piece : all.pieces) {
    if (piece.center.template head<2>().cwiseAbs().maxCoeff() >= 2.0) continue;  // At the window's border the wall goes on as at it.
    EXPECT_GT(piece.normal[0] + piece.normal[1], 0.97 * std::sqrt(2.0));
  }
}

}  // namespace
}  // namespace vantage
