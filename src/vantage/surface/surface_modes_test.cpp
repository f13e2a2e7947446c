// SPDX-License-Identifier: Apache-2.0
// The tolerance that follows the sensor, and points that count as cells.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/geometry/angle.h"
#include "vantage/surface/test_clouds.h"

namespace vantage {
namespace {

template <class T>
class SurfaceModes : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SurfaceModes, Dims);

constexpr double kStep = radians(2.0);

/// What a spinning scanner at `from` sees of the ground (last coordinate 0) up to 40 m: the points thin out with the range.
template <int Dim>
Cloud<Dim> ground_from(const Vec<Dim>& from) {
  Cloud<Dim> cloud;
  const int columns = Dim == 2 ? 2 : 180;
  for (int column = 0; column < columns; ++column)
    for (double down = kStep; down < 0.5 * kPi; down += kStep) {
      const double range = from[Dim - 1] / std::tan(down), azimuth = 2.0 * kPi * column / columns;
      if (range > 40.0) continue;
      Vec<Dim> p = from;
      p[0] += range * std::cos(azimuth);
      if (Dim == 3) p[1] += range * std::sin(azimuth);
      p[Dim - 1] = 0.0;
      cloud.push_back(p);
    }
  return cloud;
}

template <int Dim>
SurfaceSensor<Dim> sensor_at(double along) {
  Vec<Dim> p = Vec<Dim>::Zero();
  p[0] = along;
  p[Dim - 1] = 2.0;
  return {p, kStep};
}

template <int Dim>
HausdorffTree<Dim> ground_tree(const SurfaceOptions& options) {
  HausdorffTree<Dim> tree(domain<Dim>(50.0), options);
  const auto sensor = sensor_at<Dim>(0.0);
  tree.insert(ground_from<Dim>(sensor.position), sensor);
  return tree;
}

TYPED_TEST(SurfaceModes, SensorSpacingJoinsWhatIsFarAway) {
  constexpr int Dim = TypeParam::value;
  const auto cloud = ground_from<Dim>(sensor_at<Dim>(0.0).position);
  const SurfaceOptions fixed{.eta = 0.1}, sensor{.eta = 0.1, .spacing = SurfaceOptions::Spacing::sensor, .spacing_factor = 1.5, .spacing_most = 20.0};
  const auto near = ground_tree<Dim>(fixed), far = ground_tree<Dim>(sensor);
  EXPECT_LT(far.patches().size(), near.patches().size() / 2);
  const SurfaceStatistics statistics = far.statistics();
  EXPECT_EQ(near.statistics().beyond_eta, 0);
  EXPECT_GT(statistics.beyond_eta, 0);
  EXPECT_GT(statistics.surface_to_data, 0.1);  // Said openly, ...
  EXPECT_LE(statistics.surface_to_data, 20.0 * (1.0 + 1e-6));
  EXPECT_LE(statistics.data_to_surface, 0.1);  // ... and nothing measured is lost.
  EXPECT_LE(data_to_surface(cloud, far.patches()), statistics.data_to_surface);
  EXPECT_LE(surface_to_data(far.patches(), cloud, 8), statistics.surface_to_data);
}

TYPED_TEST(SurfaceModes, ANearerScanShowsWhatAFarOneBridged) {
  constexpr int Dim = TypeParam::value;
  const SurfaceOptions options{.eta = 0.1, .spacing = SurfaceOptions::Spacing::sensor, .spacing_factor = 1.5, .spacing_most = 5.0};
  // A wall at 30 m with a gap of 1 m, seen from far away and from near by.
  const auto wall = [](double apart) {
    Cloud<Dim> cloud;
    for (double y = -6.0; y <= 6.0; y += apart)
      for (double z = 0.0; z <= (Dim == 3 ? 3.0 : 0.0); z += apart) {
        if (std::abs(y) < 0.5) continue;
        Vec<Dim> p = Vec<Dim>::Zero();
        p[0] = 30.0;
        p[1] = y;
        p[Dim - 1] += Dim == 3 ? z : 0.0;
        cloud.push_back(p);
      }
    return cloud;
  };
  Vec<Dim> middle = Vec<Dim>::Zero();
  middle[0] = 30.0;
  if (Dim == 3) middle[2] = 1.5;
  const SurfaceSensor<Dim> far{Vec<Dim>::Zero(), kStep}, near{Vec<Dim>(27.0 * Vec<Dim>::Unit(0)), kStep};
  HausdorffTree<Dim> tree(domain<Dim>(50.0), options);
  tree.insert(wall(30.0 * kStep), far);
  EXPECT_LT(distance_to(tree.patches(), middle), 0.1);
  tree.insert(wall(3.0 * kStep), near);
  EXPECT_GT(distance_to(tree.patches(), middle), 0.3);
  tree.remove(wall(3.0 * kStep), near);
  EXPECT_LT(distance_to(tree.patches(), middle), 0.1);
  expect_same(tree, [&] {
    HausdorffTree<Dim> alone(domain<Dim>(50.0), options);
    alone.insert(wall(30.0 * kStep), far);
    return alone;
  }());
}

TYPED_TEST(SurfaceModes, HistoriesOfScansEndInTheSameTree) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(rc::check([] {
    const bool cells = *rc::gen::arbitrary<bool>();
    SurfaceOptions options{.eta = *rc::gen::element(0.1, 0.5), .max_depth = 7};
    if (cells) options.quantise = *rc::gen::element(0.02, 0.07);
    if (!cells) options.spacing = SurfaceOptions::Spacing::sensor;
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<std::pair<Cloud<Dim>, SurfaceSensor<Dim>>> scans;
    for (int i = 0; i < 6; ++i)
      scans.emplace_back(scene<Dim>(random.next(), random.below(random.below(4) == 0 ? 3000 : 400)),
                         SurfaceSensor<Dim>{anywhere<Dim>(random, 5.0), 0.05});
    HausdorffTree<Dim> tree(domain<Dim>(), options), kept(domain<Dim>(), options);
    for (const auto& [points, sensor] : scans) tree.insert(points, sensor);
    for (const int i : {4, 1, 3}) tree.remove(scans[i].first, scans[i].second);
    for (const int i : {5, 0, 2}) kept.insert(scans[i].first, scans[i].second);
    expect_same(tree, kept);
    RC_ASSERT(!::testing::Test::HasFailure());
  }));
}

TYPED_TEST(SurfaceModes, CellsBoundTheMemoryAndEnterTheCertificate) {
  constexpr int Dim = TypeParam::value;
  const SurfaceOptions options{.eta = 0.3, .quantise = 0.1};
  HausdorffTree<Dim> tree(domain<Dim>(), options);
  Cloud<Dim> all;
  std::int64_t patches_before = 0;
  Random random(3);
  for (int round = 0; round < 8; ++round) {  // The same scene again and again, every time 4 mm beside.
    Cloud<Dim> cloud = scene<Dim>(2, 4000);
    for (Vec<Dim>& p : cloud) p += anywhere<Dim>(random, 0.004);
    std::erase_if(cloud, [](const Vec<Dim>& p) { return !domain<Dim>().contains(p); });
    EXPECT_EQ(tree.insert(cloud).points, static_cast<std::int64_t>(cloud.size()));
    all.insert(all.end(), cloud.begin(), cloud.end());
    const auto patches = static_cast<std::int64_t>(tree.patches().size());
    if (round > 3) {
      EXPECT_LT(patches, patches_before + patches_before / 10 + 4);
    }
    patches_before = patches;
  }
  expect_certified(tree, all);
  EXPECT_GT(tree.statistics().data_to_surface, 0.5 * 0.1);  // Half a cell's diagonal is in it.
}

TYPED_TEST(SurfaceModes, PointsOfOneCellAreNoNews) {
  constexpr int Dim = TypeParam::value;
  HausdorffTree<Dim> tree(domain<Dim>(), {.eta = 0.3, .quantise = 0.1});
  const auto cloud = scene<Dim>(4, 3000);
  tree.insert(cloud);
  const auto update = tree.insert(cloud);
  EXPECT_EQ(update.points, static_cast<std::int64_t>(cloud.size()));
  EXPECT_TRUE(update.changed.empty());
  EXPECT_EQ(tree.statistics().points, 2 * static_cast<std::int64_t>(cloud.size()));
  EXPECT_EQ(tree.remove(cloud).points, static_cast<std::int64_t>(cloud.size()));
  HausdorffTree<Dim> once(domain<Dim>(), {.eta = 0.3, .quantise = 0.1});
  once.insert(cloud);
  expect_same(tree, once);
}

TYPED_TEST(SurfaceModes, WhatDoesNotGoTogetherIsRefused) {
  constexpr int Dim = TypeParam::value;
  const auto with = [](SurfaceOptions options) { return HausdorffTree<Dim>(domain<Dim>(), options); };
  EXPECT_THROW(with({.eta = 0.1, .quantise = 0.1}), Error);
  EXPECT_THROW(with({.spacing = SurfaceOptions::Spacing::sensor, .quantise = 0.01}), Error);
  EXPECT_THROW(with({.paper = true, .spacing = SurfaceOptions::Spacing::sensor}), Error);
  auto tree = with({.spacing = SurfaceOptions::Spacing::sensor});
  EXPECT_THROW(tree.insert(scene<Dim>(1, 10)), Error);  // Whose points?
  EXPECT_THROW(tree.insert(scene<Dim>(1, 10), SurfaceSensor<Dim>{Vec<Dim>::Zero(), 0.0}), Error);
  EXPECT_EQ(tree.statistics().points, 0);
}

}  // namespace
}  // namespace vantage
