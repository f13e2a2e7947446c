// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/smooth.h"

#include <gtest/gtest.h>

#include <cstring>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

template <class T>
class Smooth : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Smooth, Dims);

constexpr double kNoise = 0.05;

/// In a box of half width 4, with half of the wall ahead pushed 1 m inwards.
template <int Dim>
double true_range(const Vec<Dim>& ray) {
  double range = kInfinity;
  for (int a = 0; a < Dim; ++a)
    if (ray[a] != 0.0) range = std::min(range, 4.0 / std::abs(ray[a]));
  if (ray[0] > 0.0 && 3.0 / ray[0] < range && ray[1] > 0.0) range = 3.0 / ray[0];
  return range;
}

template <int Dim>
Scan<Dim> noisy_room() {
  Scan<Dim> scan;
  scan.pattern.step = radians(Dim == 2 ? 0.5 : 3.0);
  Random random(5);
  for (const Vec<Dim>& ray : directions<Dim>(scan.pattern))
    scan.ranges.push_back(static_cast<float>(true_range<Dim>(ray) + kNoise * random.normal()));
  return scan;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Mean square distance from the truth of the hits left, and the largest.
template <int Dim>
std::pair<double, double> error(const Scan<Dim>& scan) {
  const auto rays = directions<Dim>(scan.pattern);
  double squares = 0.0, most = 0.0;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!std::isfinite(scan.ranges[i])) continue;
    const double off = std::abs(static_cast<double>(scan.ranges[i]) - true_range<Dim>(rays[i]));
    squares += off * off;
    most = std::max(most, off);
    ++count;
  }
  return {std::sqrt(squares / static_cast<double>(count)), most};
}

TYPED_TEST(Smooth, HitsComeNearerToTheWallsAndEdgesStay) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = noisy_room<Dim>();
  const auto before = error(scan);
  const auto count = static_cast<double>(scan.ranges.size());
  const Smoothed smoothed = put_on_planes(scan, kNoise);
  const auto after = error(scan);
  EXPECT_NEAR(before.first, kNoise, 0.1 * kNoise);
  EXPECT_LT(after.first, 0.5 * kNoise);
  EXPECT_LT(after.second, 6.0 * kNoise);  // The step of 20 deviations is no ramp.
  EXPECT_GT(static_cast<double>(smoothed.moved), 0.9 * count);
  EXPECT_LT(static_cast<double>(smoothed.dropped), 0.01 * count);
}

TYPED_TEST(Smooth, StraysBeforeWallsGiveNoData) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = noisy_room<Dim>();
  Random random(6);
  std::vector<std::size_t> strays;
  for (std::size_t i = 3; i < scan.ranges.size(); i += 29) {
    strays.push_back(i);
    scan.ranges[i] = static_cast<float>(random.uniform(0.2, 0.6) * static_cast<double>(scan.ranges[i]));
  }
  const Smoothed smoothed = put_on_planes(scan, kNoise);
  const auto left = std::count_if(strays.begin(), strays.end(), [&](std::size_t i) { return std::isfinite(scan.ranges[i]); });
  EXPECT_LT(static_cast<double>(left), 0.2 * static_cast<double>(strays.size()));  // Those near edges.
  EXPECT_LT(static_cast<double>(smoothed.dropped), 1.3 * static_cast<double>(strays.size()));
}

/// A pole two rays wide before a wall.
TYPED_TEST(Smooth, PolesStay) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = noisy_room<Dim>();
  const int rows = scan.pattern.template rows<Dim>(), column = scan.pattern.columns() / 4;  // Ahead along the second axis.
  for (int c = column; c < column + (Dim == 2 ? 3 : 2); ++c)
    for (int r = 0; r < rows; ++r) scan.ranges[static_cast<std::size_t>(c * rows + r)] = static_cast<float>(2.0 + 0.5 * kNoise);
  (void)put_on_planes(scan, kNoise);
  for (int c = column; c < column + (Dim == 2 ? 3 : 2); ++c) EXPECT_NEAR(scan.range(c, rows / 2), 2.0, 3.0 * kNoise);
}

TYPED_TEST(Smooth, NothingIsDoneWithoutNoiseOrWithFewHits) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = noisy_room<Dim>();
  const auto before = scan.ranges;
  EXPECT_EQ(put_on_planes(scan, 0.0).moved, 0);
  EXPECT_TRUE(same_bits(scan.ranges, before));
  std::fill(scan.ranges.begin(), scan.ranges.end(), kNoReturn);
  scan.ranges[scan.ranges.size() / 2] = 3.0F;
  const Smoothed alone = put_on_planes(scan, kNoise);
  EXPECT_EQ(alone.moved + alone.dropped, 0);
}

TYPED_TEST(Smooth, SameBitsOnEveryThread) {
  constexpr int Dim = TypeParam::value;
  const auto ranges = [](int threads) {
    const ThreadLimit limit(threads);
    Scan<Dim> scan = noisy_room<Dim>();
    (void)put_on_planes(scan, kNoise);
    return scan.ranges;
  };
  EXPECT_TRUE(same_bits(ranges(1), ranges(5)));
}

}  // namespace
}  // namespace vantage
