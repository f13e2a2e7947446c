// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/moved.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

template <class T>
class Moved : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Moved, Dims);

constexpr double kGap = 0.1;

/// Where a ray enters a ball, or infinity [m].
template <int Dim>
double to_ball(const Vec<Dim>& from, const Vec<Dim>& ray, const Vec<Dim>& centre, double radius) {
  const Vec<Dim> d = centre - from;
  const double along = d.dot(ray), square = radius * radius - d.squaredNorm() + along * along;
  return square < 0.0 || along < std::sqrt(square) ? kInfinity : along - std::sqrt(square);
}

/// From `origin` in a box of half width 5, with a ball of 0.5 m if there is one.
template <int Dim>
Scan<Dim> in_room(const Vec<Dim>& origin, const std::optional<Vec<Dim>>& ball) {
  Scan<Dim> scan;
  scan.pattern.step = radians(Dim == 2 ? 0.5 : 2.0);
  scan.origin = origin;
  for (const Vec<Dim>& ray : directions<Dim>(scan.pattern)) {
    double range = ball ? to_ball<Dim>(origin, ray, *ball, 0.5) : kInfinity;
    for (int a = 0; a < Dim; ++a)
      if (ray[a] != 0.0) range = std::min(range, ((ray[a] > 0.0 ? 5.0 : -5.0) - origin[a]) / ray[a]);
    scan.ranges.push_back(static_cast<float>(range));
  }
  return scan;
}

template <int Dim>
Vec<Dim> place(double x, double y) {
  Vec<Dim> p = Vec<Dim>::Constant(0.3);
  p[0] = x;
  p[1] = y;
  return p;
}

template <int Dim>
std::size_t on_ball(const Scan<Dim>& scan, const Vec<Dim>& ball) {
  const auto points = hit_points(scan);
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const Vec<Dim>& p) { return (p - ball).norm() < 0.51; }));
}

TYPED_TEST(Moved, WhatStoodInOneScanOnlyGoesAndAllElseStays) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> ball = place<Dim>(1.0, 1.5);
  const std::vector<Scan<Dim>> scans = {in_room<Dim>(place<Dim>(-3.0, 0.0), ball), in_room<Dim>(place<Dim>(3.0, -2.0), std::nullopt)};
  const auto moved = moved_points(scans, kGap);
  const std::size_t before = on_ball(scans[0], ball);
  ASSERT_GT(before, 10U);
  EXPECT_EQ(moved[0].size(), before);
  EXPECT_TRUE(moved[1].empty());
  const Scan<Dim> left = without_points(scans[0], moved[0]);
  EXPECT_EQ(on_ball(left, ball), 0U);
  EXPECT_EQ(hit_points(left).size(), hit_points(scans[0]).size() - before);
}

TYPED_TEST(Moved, WhatAThirdScanHitsAsWellStays) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> ball = place<Dim>(1.0, 1.5);
  const std::vector<Scan<Dim>> scans = {in_room<Dim>(place<Dim>(-3.0, 0.0), ball), in_room<Dim>(place<Dim>(3.0, -2.0), std::nullopt),
                                        in_room<Dim>(place<Dim>(-3.0, 0.1), ball)};
  const auto moved = moved_points(scans, kGap);
  EXPECT_LT(moved[0].size(), on_ball(scans[0], ball) / 5);  // All but the rim.
}

TYPED_TEST(Moved, NothingMovesInAStillRoomWhereverTheScansStand) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> ball = place<Dim>(1.0, 1.5);
  std::vector<Scan<Dim>> scans;
  for (const double x : {-4.9, -2.0, 0.0, 3.0, 4.9})
    for (const double y : {-4.5, 0.0, 4.9}) scans.push_back(in_room<Dim>(place<Dim>(x, y), ball));
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (const auto& numbers : moved_points<Dim>({scans[a], scans[b]}, kGap)) EXPECT_TRUE(numbers.empty()) << a << ' ' << b;
}

TYPED_TEST(Moved, MeasuredPointsGoAndTheirRaysGiveNoData) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = in_room<Dim>(place<Dim>(0.0, 0.0), std::nullopt);
  scan.points = hit_points(scan);
  const Scan<Dim> left = without_points(scan, {0, 7});
  const auto rays = directions<Dim>(scan.pattern);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double turned = std::min((rays[0] - rays[i]).norm(), (rays[7] - rays[i]).norm());
    EXPECT_TRUE(turned >= 1e-6 || std::isnan(left.ranges[i])) << i;
    EXPECT_TRUE(turned <= 2.0 * Dim * scan.pattern.step || left.ranges[i] == scan.ranges[i]) << i;
  }
  ASSERT_EQ(left.points.size(), scan.points.size() - 2);
  EXPECT_EQ(left.points[0], scan.points[1]);
  EXPECT_EQ(left.points[6], scan.points[8]);
  std::vector<std::size_t> all(scan.points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  EXPECT_TRUE(hit_points(without_points(scan, all)).empty());
}

TYPED_TEST(Moved, SameOnEveryThread) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> ball = place<Dim>(1.0, 1.5);
  const std::vector<Scan<Dim>> scans = {in_room<Dim>(place<Dim>(-3.0, 0.0), ball), in_room<Dim>(place<Dim>(3.0, -2.0), std::nullopt)};
  const auto on = [&](int threads) {
    const ThreadLimit limit(threads);
    return moved_points(scans, kGap);
  };
  EXPECT_EQ(on(1), on(5));
}

}  // namespace
}  // namespace vantage
