// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/repeated.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "vantage/base/random.h"
#include "vantage/geometry/box.h"
#include "vantage/scan/bin_points.h"
#include "vantage/session/point_filter.h"

namespace vantage {
namespace {

/// What a scanner meets around it: a box, and a pillar in it.
struct Hall {
  Box<3> box;
  bool pillar = false;

  [[nodiscard]] double range(const Vec<3>& from, const Vec<3>& d) const {
    double range = kInfinity;
    for (int a = 0; a < 3; ++a)
      if (d[a] != 0.0) range = std::min(range, ((d[a] > 0.0 ? box.high : box.low)[a] - from[a]) / d[a]);
    if (!pillar) return range;
    const Vec<2> u = d.head<2>(), v = from.head<2>() - Vec<2>(3.0, 1.0);
    const double A = u.squaredNorm(), B = u.dot(v), root = B * B - A * (v.squaredNorm() - 0.25);
    return root > 0.0 && B < 0.0 ? std::min(range, (-B - std::sqrt(root)) / A) : range;
  }
};

constexpr double kFar = 40.0;
const Hall kCorridor{{{-30.0, -1.2, 0.0}, {30.0, 1.2, 2.6}}};
const Hall kPlain{{{-1e9, -1e9, 0.0}, {1e9, 1e9, 1e9}}, true};
const Hall kRoom{{{-4.0, -3.0, 0.0}, {6.0, 5.0, 3.0}}, true};

/// How a scan is taken.
struct Taking {
  Vec<3> at = {0.0, 0.0, 1.6};
  double noise = 0.0;  ///< Along the rays [m].
  std::uint64_t seed = 1;
  double step = 3.0;    ///< [deg]
  double turned = 0.0;  ///< About the vertical [rad].
};

/// A person's scan: points, and the image made from them.
Scan<3> taken(const Hall& hall, const Taking& how, FilterOptions::What filter = FilterOptions::What::none) {
  Random random(how.seed);
  Pose<3> pose{how.at, Eigen::AngleAxisd(how.turned, Vec<3>::UnitZ()).toRotationMatrix()};
  std::vector<Vec<3>> points;
  for (double azimuth = -180.0; azimuth < 179.9; azimuth += how.step)
    for (double elevation = -70.0; elevation <= 70.0; elevation += how.step) {
      const auto [sa, ca] = sin_cos(radians(azimuth));
      const auto [se, ce] = sin_cos(radians(elevation));
      const Vec<3> d = pose.world_from_sensor * Vec<3>(ce * ca, ce * sa, se);
      const double range = hall.range(how.at, d) + how.noise * random.normal();
      if (range < kFar) points.push_back(how.at + range * d);
    }
  BinnedScan<3> binned = bin_points<3>(points, pose, {0.0, 0.3, kFar, true});
  FilterOptions options;
  options.what = filter;
  options.radius = 1.5;  // Takes much of what is far off.
  (void)filter_points(binned.scan.points, pose, binned.report.step, options);
  return binned.scan;
}

TEST(Repetition, TwoPlacesOfOneCorridorAreTwoScans) {
  const Scan<3> first = taken(kCorridor, {});
  for (const double x : {0.3, 2.0, 10.0}) {
    EXPECT_FALSE(repetition(taken(kCorridor, {{x, 0.0, 1.6}}), first)) << x;
    EXPECT_FALSE(repetition(taken(kCorridor, {{x, 0.3, 1.6}}), first)) << x;
    EXPECT_FALSE(repetition(taken(kCorridor, {{x, 0.0, 1.6}, 0.01}), taken(kCorridor, {{0.0, 0.0, 1.6}, 0.01}))) << x;  // Even the same noise.
  }
}

TEST(Repetition, TwoPlacesOfAnOpenPlaneAreTwoScans) {
  for (const Vec<3>& at : {Vec<3>(10, 0, 1.6), Vec<3>(0, 6, 1.6), Vec<3>(300, 0, 1.6)})
    EXPECT_FALSE(repetition(taken(kPlain, {at}), taken(kPlain, {}))) << at.transpose();
}

TEST(Repetition, TheSameScanIsFoundWithNoiseAndAsAnotherFile) {
  for (const Hall& hall : {kCorridor, kPlain, kRoom}) {
    const Scan<3> first = taken(hall, {{0.0, 0.0, 1.6}, 0.01});
    ASSERT_TRUE(repetition(first, first));
    EXPECT_EQ(repetition(first, first)->share, 1.0);
    EXPECT_TRUE(repetition(taken(hall, {{0.01, -0.01, 1.6}, 0.01, 2}), first));           // The same view, other noise.
    EXPECT_TRUE(repetition(taken(hall, {{0.0, 0.0, 1.6}, 0.01, 2, 3.0, 0.026}), first));  // Its rays between those.
    Scan<3> rounded = first, elsewhere = first;
    for (Vec<3>& p : rounded.points) p = (p * 1000.0).array().round() / 1000.0;  // As a text file.
    std::reverse(rounded.points.begin(), rounded.points.end());
    elsewhere.origin += Vec<3>(1.0, 0.0, 0.0);  // Its points where they were, by a wrong --at.
    rounded.origin += Vec<3>(0.5, 0.0, 0.0);
    EXPECT_TRUE(repetition(rounded, first));
    EXPECT_TRUE(repetition(elsewhere, first));
  }
}

TEST(Repetition, AFilterDoesNotHideIt) {
  using What = FilterOptions::What;
  const Taking how{{0.0, 0.0, 1.6}, 0.02};
  const Scan<3> all = taken(kRoom, how), some = taken(kRoom, how, What::isolated);
  ASSERT_LT(some.points.size(), all.points.size() * 9 / 10);
  EXPECT_TRUE(repetition(all, some));
  EXPECT_TRUE(repetition(some, all));
}

TEST(Repetition, OneScanWithTwoPosesIsFound) {
  const Scan<3> first = taken(kRoom, {});
  Scan<3> moved = first;
  moved.origin = {1.0, 1.5, 1.6};
  moved.world_from_sensor = Eigen::AngleAxisd(1.0, Vec<3>::UnitZ()).toRotationMatrix();
  for (Vec<3>& p : moved.points) p = moved.world_from_sensor * (p - first.origin) + moved.origin;
  ASSERT_TRUE(repetition(moved, first));
  EXPECT_NE(repetition(moved, first)->how, repetition(first, first)->how);
  EXPECT_FALSE(repetition(taken(kRoom, {{1.0, 1.5, 1.6}, 0.0, 1, 3.0, 1.0}), first));
}

TEST(Repetition, WhatShowsMoreFromTheSamePlaceIsNew) {
  const Taking coarse{{0.0, 0.0, 1.6}, 0.01}, fine{{0.0, 0.0, 1.6}, 0.01, 2, 1.5};
  EXPECT_FALSE(repetition(taken(kRoom, fine), taken(kRoom, coarse)));  // Denser rays.
  EXPECT_TRUE(repetition(taken(kRoom, coarse), taken(kRoom, fine)));   // Nothing but what the other shows.
  Hall changed = kRoom;
  changed.box.high[2] = 2.7;  // A ceiling was put in.
  EXPECT_FALSE(repetition(taken(changed, {{0.0, 0.0, 1.6}, 0.01}), taken(kRoom, coarse)));
}

}  // namespace
}  // namespace vantage
