// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/bin_points.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"

namespace vantage {
namespace {

/// Range along a ray from inside a box, or infinity where it leaves through the top.
template <int Dim>
float range_in_box(const Vec<Dim>& from, const Vec<Dim>& d, const Vec<Dim>& half, bool open_top) {
  double least = kInfinity;
  int side = 0;
  for (int a = 0; a < Dim; ++a) {
    if (std::abs(d[a]) < 1e-12) continue;
    const double t = ((d[a] > 0.0 ? half[a] : -half[a]) - from[a]) / d[a];
    if (t < least) least = t, side = a;
  }
  return open_top && side == Dim - 1 && d[side] > 0.0 ? kNoReturn : static_cast<float>(least);
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> yaw(double angle) {
  Eigen::Matrix<double, Dim, Dim> r = Eigen::Matrix<double, Dim, Dim>::Identity();
  const auto [s, c] = sin_cos(angle);
  r(0, 0) = r(1, 1) = c;
  r(0, 1) = -s;
  r(1, 0) = s;
  return r;
}

/// A scan in a box 12 m wide and 8 m high, by a sensor turned and moved.
template <int Dim>
Scan<Dim> scan_in_box(double step, bool open_top) {
  Scan<Dim> scan;
  scan.pattern.step = step;
  scan.pattern.vertical_fov = radians(120.0) - step;
  scan.origin = Vec<Dim>::Constant(0.7);
  scan.world_from_sensor = yaw<Dim>(0.31);
  Vec<Dim> half = Vec<Dim>::Constant(6.0);
  half[Dim - 1] = 4.0;
  for (const Vec<Dim>& d : directions<Dim>(scan.pattern))
    scan.ranges.push_back(range_in_box<Dim>(scan.origin, Vec<Dim>(scan.world_from_sensor * d), half, open_top));
  return scan;
}

template <class T>
class BinPointsTest : public ::testing::Test {};
template <int D>
struct Dimension {
  static constexpr int value = D;
};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(BinPointsTest, Dimensions);

TYPED_TEST(BinPointsTest, ASimulatedScanComesBackRayByRay) {
  constexpr int Dim = TypeParam::value;
  for (const double step : {radians(0.5), radians(2.0), radians(3.6)}) {
    const Scan<Dim> scan = scan_in_box<Dim>(step, false);
    const std::vector<Vec<Dim>> points = hit_points(scan);
    const BinnedScan<Dim> binned = bin_points<Dim>(points, Pose<Dim>{scan.origin, scan.world_from_sensor}, BinOptions{});
    EXPECT_NEAR(binned.report.step, step, 1e-12);
    EXPECT_EQ(binned.report.hit, static_cast<std::int64_t>(points.size()));
    EXPECT_EQ(binned.scan.points, points);
    // Every ray's direction in the world finds its own range again.
    const std::vector<Vec<Dim>> rays = directions<Dim>(binned.scan.pattern);
    ASSERT_EQ(rays.size(), binned.scan.ranges.size());
    std::size_t hits = 0;
    Vec<Dim> half = Vec<Dim>::Constant(6.0);
    half[Dim - 1] = 4.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!std::isfinite(binned.scan.ranges[i])) continue;
      const Vec<Dim> d = binned.scan.world_from_sensor * rays[i];
      ++hits;
      EXPECT_NEAR(binned.scan.ranges[i], range_in_box<Dim>(scan.origin, d, half, false), 1e-3);
    }
    EXPECT_EQ(hits, points.size());
  }
}

TYPED_TEST(BinPointsTest, AMovedAndTurnedPlaceMakesTheSameImage) {
  constexpr int Dim = TypeParam::value;
  const Scan<Dim> scan = scan_in_box<Dim>(radians(2.0), true);
  const std::vector<Vec<Dim>> points = hit_points(scan);
  const Eigen::Matrix<double, Dim, Dim> turn = yaw<Dim>(-1.234);
  const Vec<Dim> move = Vec<Dim>::Constant(1000.25);
  std::vector<Vec<Dim>> moved;
  for (const Vec<Dim>& p : points) moved.push_back(turn * p + move);
  const BinnedScan<Dim> a = bin_points<Dim>(points, Pose<Dim>{scan.origin, scan.world_from_sensor}, BinOptions{});
  const BinnedScan<Dim> b = bin_points<Dim>(moved, Pose<Dim>{turn * scan.origin + move, turn * scan.world_from_sensor}, BinOptions{});
  ASSERT_EQ(a.scan.ranges.size(), b.scan.ranges.size());
  for (std::size_t i = 0; i < a.scan.ranges.size(); ++i)
    EXPECT_TRUE(std::isfinite(a.scan.ranges[i]) ? std::abs(a.scan.ranges[i] - b.scan.ranges[i]) < 1e-3F
                                                : std::isnan(a.scan.ranges[i]) == std::isnan(b.scan.ranges[i]));
}

TYPED_TEST(BinPointsTest, RangesAndTheNearestOfABin) {
  constexpr int Dim = TypeParam::value;
  std::vector<Vec<Dim>> points;
  for (const double x : {0.1, 4.0, 3.0, 50.0}) points.push_back(x * Vec<Dim>::Unit(0));
  const BinnedScan<Dim> binned = bin_points<Dim>(points, Pose<Dim>{}, BinOptions{radians(5.0), 0.5, 20.0, true});
  EXPECT_EQ(binned.report.near, 1);
  EXPECT_EQ(binned.report.far, 1);
  EXPECT_EQ(binned.report.points, 2);
  EXPECT_EQ(binned.scan.points.size(), 2U);
  std::vector<float> hits;
  for (const float r : binned.scan.ranges)
    if (std::isfinite(r)) hits.push_back(r);
  EXPECT_EQ(hits, std::vector<float>{3.0F});
  EXPECT_THROW(static_cast<void>(bin_points<Dim>(points, Pose<Dim>{}, BinOptions{0.0, 60.0, 80.0, true})), Error);
}

TEST(BinPoints, TheSkyIsFreeWithinTheFieldOfViewOnly) {
  const Scan<3> scan = scan_in_box<3>(radians(2.0), true);
  const std::vector<Vec<3>> points = hit_points(scan);
  const Pose<3> pose{scan.origin, scan.world_from_sensor};
  const BinnedScan<3> free = bin_points<3>(points, pose, BinOptions{});
  const BinnedScan<3> unknown = bin_points<3>(points, pose, BinOptions{0.0, 0.0, 80.0, false});
  Vec<3> half(6.0, 6.0, 4.0);
  const std::vector<Vec<3>> rays = directions<3>(free.scan.pattern);
  std::int64_t open = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec<3> d = free.scan.world_from_sensor * rays[i];
    const bool sky = range_in_box<3>(scan.origin, d, half, true) == kNoReturn;
    if (free.scan.ranges[i] == kNoReturn) {
      ++open;
      EXPECT_TRUE(sky);
      EXPECT_TRUE(std::isnan(unknown.scan.ranges[i]));
      const double elevation = angle_of(d[2], d.head<2>().norm());
      EXPECT_GE(elevation, free.report.lowest - 1e-9);
      EXPECT_LE(elevation, free.report.highest + 1e-9);
    }
  }
  EXPECT_EQ(open, free.report.empty);
  EXPECT_GT(open, 100);
}

TEST(BinPoints, AGapInTheAzimuthIsOutsideOfTheView) {
  std::vector<Vec<2>> points;
  for (int k = 0; k < 270; ++k) {
    const auto [s, c] = sin_cos(radians(k));
    points.push_back(5.0 * Vec<2>(c, s));
  }
  const BinnedScan<2> binned = bin_points<2>(points, Pose<2>{}, BinOptions{});
  EXPECT_NEAR(degrees(binned.report.step), 1.0, 1e-9);
  EXPECT_EQ(binned.report.hit, 270);
  EXPECT_EQ(binned.report.outside, 90);
  EXPECT_EQ(binned.report.empty, 0);
}

TEST(BinPoints, OfOrganisedRaysTheEmptyOnesAreFreeAndThoseNotFiredUnknown) {
  // 36 columns of three rays; the upper ray of every second column came back empty, those of the last column were not fired.
  std::vector<Vec<3>> points;
  std::vector<std::int32_t> order;
  for (int c = 0; c < 36; ++c)
    for (int r = 0; r < 3; ++r) {
      const bool fired = c < 35, empty = r == 2 && c % 2 == 0;
      order.push_back(!fired ? -2 : empty ? -1 : static_cast<std::int32_t>(points.size()));
      if (!fired || empty) continue;
      const auto [s, k] = sin_cos(radians(10.0 * c));
      const auto [up, flat] = sin_cos(radians(10.0 * (r - 1)));
      points.push_back(7.0 * Vec<3>(flat * k, flat * s, up));
    }
  const BinOptions options{radians(10.0), 0.0, 80.0, false};
  const BinnedScan<3> binned = bin_points<3>(points, Pose<3>{}, options, RayOrder{36, 3, order});
  EXPECT_EQ(std::count(binned.scan.ranges.begin(), binned.scan.ranges.end(), kNoReturn), 18);
  EXPECT_EQ(binned.report.empty, 18);
}

TEST(BinPoints, ATableWhoseHitsLieElsewhereIsNotBelieved) {
  // The same table the wrong way round: 36 rows of one azimuth each. Its means would call any direction free.
  std::vector<Vec<3>> points;
  std::vector<std::int32_t> turned;
  for (int c = 0; c < 36; ++c)
    for (int r = 0; r < 3; ++r) {
      const bool empty = c % 5 == 0;
      const auto [s, k] = sin_cos(radians(10.0 * c));
      const auto [up, flat] = sin_cos(radians(10.0 * (r - 1)));
      turned.push_back(empty ? -1 : static_cast<std::int32_t>(points.size()));
      if (!empty) points.push_back(7.0 * Vec<3>(flat * k, flat * s, up));
    }
  std::vector<std::int32_t> order(turned.size());
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 36; ++r) order[c * 36 + r] = turned[r * 3 + c];
  const BinOptions options{radians(10.0), 0.0, 80.0, false};
  const auto no_returns = [&](const RayOrder& rays) {
    const BinnedScan<3> binned = bin_points<3>(points, Pose<3>{}, options, rays);
    EXPECT_EQ(binned.report.ordered, rays.columns == 36);
    return std::count(binned.scan.ranges.begin(), binned.scan.ranges.end(), kNoReturn);
  };
  EXPECT_EQ(no_returns({3, 36, order}), 0);
  EXPECT_EQ(no_returns({36, 3, turned}), 0);  // Whole columns are empty: nothing tells where they point.
}

TEST(BinPoints, AThinnedCloudHasNoHolesCloseBy) {
  // A floor 1.4 m below the scanner with a point every 10 cm: sparse in angle straight below.
  std::vector<Vec<3>> points;
  for (int i = -100; i <= 100; ++i)
    for (int j = -100; j <= 100; ++j) points.push_back({0.1 * i, 0.1 * j, -1.4});
  const BinnedScan<3> binned = bin_points<3>(points, Pose<3>{}, BinOptions{});
  const std::vector<Vec<3>> rays = directions<3>(binned.scan.pattern);
  std::int64_t below = 0, holes = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec<3> d = binned.scan.world_from_sensor * rays[i];
    if (d[2] > -0.3 || d[2] < -0.98) continue;
    ++below;
    holes += binned.scan.ranges[i] == kNoReturn ? 1 : 0;
    if (!std::isfinite(binned.scan.ranges[i])) continue;
    EXPECT_GT(binned.scan.ranges[i], 0.6 * -1.4 / d[2]);
    EXPECT_LT(binned.scan.ranges[i], 1.1 * -1.4 / d[2]);
  }
  EXPECT_GT(below, 1000);
  EXPECT_LT(holes, below / 100);
}

}  // namespace
}  // namespace vantage
