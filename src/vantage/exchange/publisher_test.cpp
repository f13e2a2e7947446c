// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/publisher.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/exchange/test_clouds.h"

namespace vantage {
namespace {

template <class Dimension>
class Publishers : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Publishers, Dimensions);

template <int Dim>
double to_patches(const std::vector<Patch<Dim>>& patches, const Vec<Dim>& p) {
  double best = kInfinity;
  for (const Patch<Dim>& patch : patches) best = std::min(best, distance(patch, p));
  return best;
}
template <int Dim>
double to_points(const std::vector<Vec<Dim>>& points, const Vec<Dim>& p) {
  double best = kInfinity;
  for (const Vec<Dim>& q : points) best = std::min(best, (q - p).norm());
  return best;
}

/// Largest distance to the points over a lattice of places of every patch.
template <int Dim>
double patches_to_points(const std::vector<Patch<Dim>>& patches, const std::vector<Vec<Dim>>& points, int density) {
  double most = 0.0;
  for (const Patch<Dim>& patch : patches)
    for (int triangle = 0; triangle < std::max(1, patch.count - 2); ++triangle) {
      const Vec<Dim>&a = patch.vertices[0], &b = patch.vertices[std::min(triangle + 1, patch.count - 1)],
            &c = patch.vertices[std::min(triangle + 2, patch.count - 1)];
      for (int i = 0; i <= density; ++i)
        for (int j = 0; i + j <= density; ++j) {
          most = std::max(most, to_points<Dim>(points, a + (b - a) * i / density + (c - a) * j / density));
          if (patch.count == 1) i = j = density;
        }
    }
  return most;
}

TYPED_TEST(Publishers, EveryDeltaKeepsItsCertificateBothWays) {
  constexpr int Dim = TypeParam::value;
  const double tolerance = 0.2 * (Dim - 1);
  Publisher<Dim> publisher("car", tolerance);
  std::vector<Patch<Dim>> all;
  std::int64_t planes = 0;
  for (std::uint64_t scan = 0; scan < 3; ++scan) {
    const std::vector<Vec<Dim>> points = corner_scan<Dim>(3000, Vec<Dim>::Constant(0.8 * static_cast<double>(scan)), scan);
    const Delta delta = publisher.publish(points);
    EXPECT_EQ(delta.number, scan);
    EXPECT_LE(std::max(delta.data_to_surface, delta.surface_to_data), tolerance);
    const std::vector<Patch<Dim>> fresh = patches<Dim>({delta.spacing}, decoded<Dim>(delta, "delta"));
    planes += std::count_if(fresh.begin(), fresh.end(), [](const auto& patch) { return patch.count > 1; });
    all.insert(all.end(), fresh.begin(), fresh.end());
    double truth = 0.0;
    for (const Vec<Dim>& p : points) truth = std::max(truth, to_patches(all, p));
    EXPECT_LE(truth, delta.data_to_surface);
    EXPECT_GT(1.1 * truth, delta.data_to_surface);
    const double back = patches_to_points(fresh, points, 12);
    EXPECT_LE(back, delta.surface_to_data);
    EXPECT_GT(1.3 * back, delta.surface_to_data);
    EXPECT_TRUE(scan == 0 || delta.new_points < delta.points);
  }
  EXPECT_GT(planes, 0);
}

/// Points on faces, edges, corners and sites of the lattice, and anywhere, near the origin and far from it.
TYPED_TEST(Publishers, TheCertificateHoldsOnTheLatticeItselfAndForAnyPoints) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    Publisher<Dim> publisher("car", 0.1);
    const double unit = round % 3 == 0 ? 0.05 : publisher.publish({}).spacing / 4.0;
    const double shift = round % 2 == 0 ? 0.0 : 4e6 * unit;
    std::vector<Vec<Dim>> points(1 + random.below(80));
    for (Vec<Dim>& p : points)
      for (int a = 0; a < Dim; ++a) p[a] = shift + unit * static_cast<double>(random.below(a + 1 == Dim && round % 4 < 2 ? 1 : 12));
    const Delta delta = publisher.publish(points);
    const std::vector<Patch<Dim>> patches = vantage::patches<Dim>({delta.spacing}, decoded<Dim>(delta, "delta"));
    for (const Vec<Dim>& p : points) EXPECT_LE(to_patches(patches, p), delta.data_to_surface);
    EXPECT_LE(patches_to_points(patches, points, 20), delta.surface_to_data);
    EXPECT_LE(std::max(delta.data_to_surface, delta.surface_to_data), 0.1);
  }
}

TYPED_TEST(Publishers, AScanSeenBeforeAddsNothing) {
  constexpr int Dim = TypeParam::value;
  Publisher<Dim> publisher("car", 0.1);
  const auto points = corner_scan<Dim>(1000, Vec<Dim>::Zero(), 1);
  EXPECT_FALSE(publisher.publish(points).code.empty());
  const Delta again = publisher.publish(points);
  EXPECT_EQ(again.new_points, 0U);
  EXPECT_TRUE(again.code.empty());
  EXPECT_LE(again.data_to_surface, 0.1);
}

TYPED_TEST(Publishers, NeitherOrderNorThreadsNorRepeatedPointsMatter) {
  constexpr int Dim = TypeParam::value;
  auto points = corner_scan<Dim>(3000, Vec<Dim>::Zero(), 2);
  const std::string once = delta_bytes(Publisher<Dim>("car", 0.1).publish(points));
  std::reverse(points.begin(), points.end());
  points.insert(points.end(), points.begin(), points.begin() + 100);
  const ThreadLimit one(1);
  EXPECT_EQ(delta_bytes(Publisher<Dim>("car", 0.1).publish(points)), once);
}

TYPED_TEST(Publishers, GoesOnWhereItsMapStops) {
  constexpr int Dim = TypeParam::value;
  const auto first = corner_scan<Dim>(1500, Vec<Dim>::Zero(), 3), second = corner_scan<Dim>(1500, Vec<Dim>::Ones(), 4);
  Publisher<Dim> through("car", 0.1), resumed("car", 0.1);
  ExchangeMap map;
  map.add(through.publish(first));
  map.add(Publisher<Dim>("bus", 0.1).publish(second));
  resumed.resume(parse_map(map.bytes(), "map"));
  EXPECT_EQ(delta_bytes(resumed.publish(second)), delta_bytes(through.publish(second)));
}

TYPED_TEST(Publishers, DegenerateScans) {
  constexpr int Dim = TypeParam::value;
  Publisher<Dim> publisher("car", 0.1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Delta none = publisher.publish(std::vector<Vec<Dim>>{});
  EXPECT_EQ(none.points, 0U);
  EXPECT_EQ(parse_delta(delta_bytes(none), "delta").points, 0U);
  const Delta bad = publisher.publish(std::vector<Vec<Dim>>{Vec<Dim>::Constant(nan), Vec<Dim>::Constant(kInfinity), Vec<Dim>::Constant(1e300)});
  EXPECT_EQ(bad.points, 0U);
  const Delta same = publisher.publish(std::vector<Vec<Dim>>(1000, Vec<Dim>::Constant(3.0)));
  EXPECT_EQ(same.points, 1U);
  EXPECT_EQ(same.counts.cells, 1U);
  std::vector<Vec<Dim>> far;  // A wall 10^6 m away, in millimetres.
  for (int i = 0; i < 20000; ++i) {
    Vec<Dim> p = Vec<Dim>::Constant(1e6);
    p[0] += 0.007 * (i / 141);
    p[Dim - 2] += 0.007 * (i % 141);
    far.push_back(p);
  }
  const Delta wall = publisher.publish(far);
  EXPECT_GT(wall.counts.planes, 0U);
  EXPECT_LE(std::max(wall.data_to_surface, wall.surface_to_data), 0.1);
  EXPECT_THROW(Publisher<Dim>("", 0.1), Error);
  EXPECT_THROW(Publisher<Dim>("car", 0.0), Error);
  EXPECT_THROW(Publisher<Dim>("car", nan), Error);
}

}  // namespace
}  // namespace vantage
