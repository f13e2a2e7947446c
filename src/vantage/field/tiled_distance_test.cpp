// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/tiled_distance.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/field/distance.h"
#include "vantage/field/line_minimum.h"
#include "vantage/field/redistance.h"

namespace vantage {
namespace {

template <class T>
class TiledDistance : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TiledDistance, Dimensions);

template <int Dim>
Field<Dim, std::uint8_t> set_of(const Index<Dim>& extent, double share, std::uint64_t seed) {
  Field<Dim, std::uint8_t> set(Grid<Dim>{0.3, Index<Dim>::Constant(-4), extent});
  Random random(seed);
  for (auto& value : set.values) value = random.uniform() < share ? 7 : 0;
  return set;
}

/// Sets from one node to nearly all, in windows whose sides are no multiple of anything.
template <int Dim, class Check>
void for_sets(Check&& check) {
  std::uint64_t seed = 1;
  for (const int side : {1, 7, 16, 40, 67})
    for (const double share : {0.0, 1e-4, 0.003, 0.05, 0.5, 0.97, 1.0}) {
      Index<Dim> extent;
      for (int a = 0; a < Dim; ++a) extent[a] = std::max(1, side - 9 * a);
      check(set_of<Dim>(extent, share, seed++));
    }
}

/// Oracle: squared distance by way of the nearest site, found by the lower envelope of parabolas.
template <int Dim>
std::vector<double> distances_by_sites(const Field<Dim, std::uint8_t>& set) {
  const Field<Dim, std::int32_t> site = nearest_sites(set);
  std::vector<double> d(set.values.size(), kInfinity);
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (site[i] == kNoSite) continue;
    const Vec<Dim> steps = (set.window.local(i) - set.window.local(static_cast<std::size_t>(site[i]))).template cast<double>();
    d[i] = std::sqrt(steps.squaredNorm()) * set.window.spacing;
  }
  return d;
}

TYPED_TEST(TiledDistance, IsTheEnvelopesToTheBit) {
  constexpr int Dim = TypeParam::value;
  for_sets<Dim>([](const Field<Dim, std::uint8_t>& set) {
    const std::vector<double> oracle = distances_by_sites(set);
    for (const double cap : {1.5, 1e9}) {
      const Field<Dim> d = tiled_distance(set, cap);
      for (std::size_t i = 0; i < oracle.size(); ++i) ASSERT_EQ(d[i], static_cast<float>(std::min(cap, oracle[i])));
    }
  });
}

TYPED_TEST(TiledDistance, SignedIsTheTwoUnsignedOnesToTheBit) {
  constexpr int Dim = TypeParam::value;
  for_sets<Dim>([](const Field<Dim, std::uint8_t>& inside) {
    Field<Dim, std::uint8_t> outside(inside.window);
    for (std::size_t i = 0; i < inside.values.size(); ++i) outside[i] = inside[i] == 0;
    const std::vector<double> to_outside = distances_by_sites(outside), to_inside = distances_by_sites(inside);
    const double h = inside.window.spacing, half = 0.5 * h;
    for (const double cap : {0.4 * h, 3.0 * h, 32.0 * h, 200.0 * h}) {
      const Field<Dim> psi = signed_distance(inside, cap);
      for (std::size_t i = 0; i < psi.values.size(); ++i) {
        const auto d = static_cast<float>(std::min(cap + half, inside[i] != 0 ? to_outside[i] : to_inside[i]));
        ASSERT_EQ(psi[i], inside[i] != 0 ? static_cast<float>(d - half) : static_cast<float>(half - d));
      }
    }
  });
}

TYPED_TEST(TiledDistance, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto set = set_of<Dim>(Index<Dim>::Constant(70), 0.01, 5);
  std::vector<std::vector<float>> plain, both;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    plain.push_back(tiled_distance(set, 1e9).values);
    both.push_back(tiled_signed_distance(set, 9.6).values);
  }
  for (const std::size_t k : {1U, 2U}) {
    EXPECT_EQ(plain[0], plain[k]);
    EXPECT_EQ(both[0], both[k]);
  }
}

/// Squares that a float no longer holds: the window is left to the sites.
TEST(WideWindows, AreExactToo) {
  Field<2, std::uint8_t> set(Grid<2>{1.0, {0, 0}, {6000, 3}});
  set[0] = 1;
  EXPECT_FALSE(exact_in_float(set.window));
  const Field<2> d = distance_to_set(set);
  EXPECT_EQ(d[5999], 5999.0F);
  EXPECT_EQ(d.at({5999, 2}), static_cast<float>(std::sqrt(5999.0 * 5999.0 + 4.0)));
}

/// Oracle: every pair of rows. Lanes are independent, some without any site.
RC_GTEST_PROP(LineMinimum, IsTheLeastOverAllRows, (std::uint64_t seed)) {
  Random random(seed);
  const auto length = 1 + static_cast<std::size_t>(random.uniform() * 90);
  std::vector<float> tile(length * kLanes), out(tile.size());
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const double share = random.uniform() * random.uniform(), largest = std::pow(10.0, random.uniform(0.0, 6.0));
    for (std::size_t i = 0; i < length; ++i)
      tile[i * kLanes + lane] = lane > 0 && random.uniform() < share ? static_cast<float>(std::floor(random.uniform() * largest)) : kFarSquare;
  }
  LineMinimum{length}(tile.data(), out.data());
  for (std::size_t k = 0; k < out.size(); ++k) {
    double least = kFarSquare;
    for (std::size_t j = 0; j < length; ++j) {
      const double step = static_cast<double>(j) - static_cast<double>(k / kLanes);
      least = std::min(least, static_cast<double>(tile[j * kLanes + k % kLanes]) + step * step);
    }
    RC_ASSERT(out[k] == static_cast<float>(least));
  }
}

}  // namespace
}  // namespace vantage
