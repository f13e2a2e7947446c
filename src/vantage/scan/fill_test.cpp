// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/fill.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

template <class T>
class Fill : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Fill, Dimensions);

/// Scan from the origin of walls x = 6 for y < 0 and x = 12 for y > 0, up to |y| = 20.
template <int Dim>
Scan<Dim> two_walls(double step_deg) {
  Scan<Dim> scan;
  scan.pattern.step = radians(step_deg);
  for (const Vec<Dim>& d : directions<Dim>(scan.pattern)) {
    const double x = d[1] < 0.0 ? 6.0 : 12.0;
    const double range = d[0] > 1e-9 ? x / d[0] : kInfinity;
    scan.ranges.push_back(std::abs(range * d[1]) < 20.0 && range < 80.0 ? static_cast<float>(range) : kNoReturn);
  }
  return scan;
}

TYPED_TEST(Fill, FillsWallsAndLeavesDepthJumpsOpen) {
  constexpr int Dim = TypeParam::value;
  const auto points = fill_between_rays(two_walls<Dim>(1.0), 0.1);
  ASSERT_GT(points.size(), 50U);
  for (const Vec<Dim>& p : points) {
    EXPECT_NEAR(p[0], p[1] < 0.0 ? 6.0 : 12.0, 0.02);
    EXPECT_LT(std::abs(p[1]), 20.0);
  }
}

TYPED_TEST(Fill, GapsAreClosedToTheSpacing) {
  constexpr int Dim = TypeParam::value;
  const Scan<Dim> scan = two_walls<Dim>(1.0);
  auto points = fill_between_rays(scan, 0.1);
  for (const Vec<Dim>& p : hit_points(scan)) points.push_back(p);
  for (double y = 1.0; y < 9.0; y += 0.037) {
    Vec<Dim> q = Vec<Dim>::Zero();
    q[0] = 12.0;
    q[1] = y;
    double nearest = kInfinity;
    for (const Vec<Dim>& p : points) nearest = std::min(nearest, (p - q).norm());
    EXPECT_LT(nearest, 0.1);
  }
}

TYPED_TEST(Fill, DenseScansNeedNone) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(fill_between_rays(two_walls<Dim>(2.0), 100.0).empty());
}

/// A door hidden between two rays stays open.
TYPED_TEST(Fill, WideGapsStayOpen) {
  constexpr int Dim = TypeParam::value;
  const double spacing = 0.1;
  const Scan<Dim> scan = two_walls<Dim>(2.0);
  for (const Vec<Dim>& p : fill_between_rays(scan, spacing)) {
    double nearest = kInfinity;
    for (const Vec<Dim>& hit : hit_points(scan)) nearest = std::min(nearest, (hit - p).norm());
    EXPECT_LE(nearest, 2.5 * std::sqrt(2.0) * spacing);
  }
}

TYPED_TEST(Fill, ScatteredHitsAreNotAWall) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = two_walls<Dim>(2.0);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) scan.ranges[i] = 10.0F + 7.0F * static_cast<float>(i * 7919 % 101) / 101.0F;
  EXPECT_LT(fill_between_rays(scan, 0.1).size(), 20U);
}

}  // namespace
}  // namespace vantage
