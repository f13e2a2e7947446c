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

/// Lower envelope of the parabolas (x - i)^2 + height[i]: for every x which i is lowest, smaller i first; kNoSite if no height is finite.
struct Envelope {
  std::vector<std::int32_t> apex;
  std::vector<double> from;  // apex[k] is lowest from here on.

  void build(const std::vector<std::int64_t>& height, std::vector<std::int32_t>& lowest) {
    apex.clear();
    from.clear();
    const auto n = static_cast<std::int32_t>(height.size());
    for (std::int32_t i = 0; i < n; ++i) {
      if (height[static_cast<std::size_t>(i)] < 0) continue;
      double start = -kInfinity;
      while (!apex.empty()) {
        const std::int32_t j = apex.back();
        const auto gap = static_cast<double>(height[static_cast<std::size_t>(i)] - height[static_cast<std::size_t>(j)]);
        start = (gap / (i - j) + (i + j)) * 0.5;
        if (start > from.back()) break;
        apex.pop_back();
        from.pop_back();
        start = -kInfinity;
      }
      apex.push_back(i);
      from.push_back(start);
    }
    std::size_t k = 0;
    for (std::int32_t x = 0; x < n; ++x) {
      while (k + 1 < apex.size() && from[k + 1] < x) ++k;
      lowest[static_cast<std::size_t>(x)] = apex.empty() ? kNoSite : apex[k];
    }
  }
};

/// Oracle: nearest sites axis by axis by the lower envelope of parabolas (Felzenszwalb and Huttenlocher 2012).
template <int Dim>
Field<Dim, std::int32_t> sites_by_envelopes(const Field<Dim, std::uint8_t>& set) {
  const Grid<Dim>& grid = set.window;
  Field<Dim, std::int64_t> squared(grid, -1);
  Field<Dim, std::int32_t> site(grid, kNoSite);
  for (std::size_t i = 0; i < set.values.size(); ++i)
    if (set[i] != 0) squared[i] = 0, site[i] = static_cast<std::int32_t>(i);
  for (int axis = 0; axis < Dim; ++axis) {
    const auto length = static_cast<std::size_t>(grid.extent[axis]);
    const std::size_t stride = grid.stride(axis);
    for (std::size_t start = 0; start < grid.size(); ++start) {
      if (start / stride % length != 0) continue;
      std::vector<std::int64_t> height(length);
      std::vector<std::int32_t> lowest(length), old(length);
      for (std::size_t i = 0; i < length; ++i) height[i] = squared[start + i * stride], old[i] = site[start + i * stride];
      Envelope().build(height, lowest);
      for (std::size_t i = 0; i < length && lowest[i] != kNoSite; ++i) {
        const auto from = static_cast<std::size_t>(lowest[i]);
        const auto step = static_cast<std::int64_t>(i) - lowest[i];
        squared[start + i * stride] = height[from] + step * step;
        site[start + i * stride] = old[from];
      }
    }
  }
  return site;
}

/// Distance to those sites.
template <int Dim>
std::vector<double> distances_by_sites(const Field<Dim, std::uint8_t>& set) {
  const Field<Dim, std::int32_t> site = sites_by_envelopes(set);
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

TYPED_TEST(TiledDistance, SitesAreTheEnvelopesTiesIncluded) {
  constexpr int Dim = TypeParam::value;
  for_sets<Dim>([](const Field<Dim, std::uint8_t>& set) { ASSERT_EQ(nearest_sites(set).values, sites_by_envelopes(set).values); });
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

/// Squares that a float no longer holds are taken in double.
TEST(WideWindows, AreExactToo) {
  Field<2, std::uint8_t> set(Grid<2>{1.0, {0, 0}, {6000, 3}});
  set[0] = 1;
  EXPECT_FALSE(exact_in_float(set.window));
  const Field<2> d = distance_to_set(set);
  EXPECT_EQ(d[5999], 5999.0F);
  EXPECT_EQ(d.at({5999, 2}), static_cast<float>(std::sqrt(5999.0 * 5999.0 + 4.0)));
  for (std::size_t i = 1; i < 40; ++i) set[i * 449] = 1;
  EXPECT_EQ(nearest_sites(set).values, sites_by_envelopes(set).values);
}

/// Oracle: every pair of rows. Lanes are independent, some without any site.
template <class Real>
void check_lines(std::uint64_t seed) {
  Random random(seed);
  const auto length = 1 + static_cast<std::size_t>(random.uniform() * 90);
  std::vector<Real> tile(length * kTileLanes), out(tile.size());
  for (std::size_t lane = 0; lane < kTileLanes; ++lane) {
    const double share = random.uniform() * random.uniform(), largest = std::pow(10.0, random.uniform(0.0, 6.0));
    for (std::size_t i = 0; i < length; ++i)
      tile[i * kTileLanes + lane] =
          lane > 0 && random.uniform() < share ? static_cast<Real>(std::floor(random.uniform() * largest)) : kFarSquare<Real>;
  }
  LineMinimum<Real>{length}(tile.data(), out.data());
  for (std::size_t k = 0; k < out.size(); ++k) {
    Real least = kFarSquare<Real>;
    for (std::size_t j = 0; j < length; ++j) {
      const Real step = static_cast<Real>(j) - static_cast<Real>(k / kTileLanes);
      least = std::min(least, tile[j * kTileLanes + k % kTileLanes] + step * step);
    }
    RC_ASSERT(out[k] == least);
  }
}

RC_GTEST_PROP(LineMinimum, IsTheLeastOverAllRows, (std::uint64_t seed)) {
  check_lines<float>(seed);
  check_lines<double>(seed);
}

}  // namespace
}  // namespace vantage
