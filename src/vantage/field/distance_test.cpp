// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/distance.h"

#include <gtest/gtest.h>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

template <class T>
class Distance : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Distance, Dimensions);

template <int Dim>
Grid<Dim> odd_window() {
  Grid<Dim> window;
  window.spacing = 0.25;
  for (int a = 0; a < Dim; ++a) {
    window.first[a] = 3 - 7 * a;
    window.extent[a] = 9 + 4 * a;
  }
  return window;
}

template <int Dim>
Field<Dim, std::uint8_t> random_set(double share, std::uint64_t seed) {
  Random random(seed);
  Field<Dim, std::uint8_t> set(odd_window<Dim>());
  for (auto& value : set.values) value = random.uniform() < share;
  return set;
}

template <int Dim>
Vec<Dim> random_place(const Box<Dim>& box, Random& random) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(box.low[a], box.high[a]);
  return p;
}

TYPED_TEST(Distance, EqualsExhaustiveSearch) {
  constexpr int Dim = TypeParam::value;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const auto set = random_set<Dim>(0.02, seed);
    const Field<Dim> d = distance_to_set(set);
    const auto sites = nearest_sites(set);
    for (std::size_t i = 0; i < d.values.size(); ++i) {
      double nearest = kInfinity;
      for (std::size_t j = 0; j < set.values.size(); ++j)
        if (set[j] != 0) nearest = std::min(nearest, (set.window.position(i) - set.window.position(j)).norm());
      ASSERT_FLOAT_EQ(d[i], static_cast<float>(nearest));
      ASSERT_NE(set[static_cast<std::size_t>(sites[i])], 0);
      ASSERT_NEAR((set.window.position(i) - set.window.position(static_cast<std::size_t>(sites[i]))).norm(), nearest, 1e-9);
    }
  }
}

/// Small caps look around the nodes near the patches only; the answer is that of looking everywhere, to the bit.
TYPED_TEST(Distance, CapOnPatchDistancesOnlyCutsThem) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  Grid<Dim> window = odd_window<Dim>();
  window.extent *= 2;
  const Box<Dim> box = window.bounds();
  std::vector<Patch<Dim>> patches;
  for (int k = 0; k < 12; ++k) {
    Patch<Dim> patch;
    patch.count = 1 + k % 2;
    for (int v = 0; v < patch.count; ++v) patch.vertices[static_cast<std::size_t>(v)] = random_place<Dim>(box, random);
    patches.push_back(patch);
  }
  const Field<Dim> all = distance_to_patches<Dim>(patches, window);
  for (const double steps : {0.3, 1.0, 2.0, 3.7, 5.0, 9.0}) {
    const double cap = steps * window.spacing;
    const Field<Dim> capped = distance_to_patches<Dim>(patches, window, cap);
    for (std::size_t i = 0; i < all.values.size(); ++i) ASSERT_EQ(capped[i], std::min(all[i], static_cast<float>(cap))) << steps;
  }
}

TYPED_TEST(Distance, EmptySetGivesTheCapAndNoSite) {
  constexpr int Dim = TypeParam::value;
  const Field<Dim, std::uint8_t> none(odd_window<Dim>());
  for (const float d : distance_to_set(none, 7.0).values) EXPECT_EQ(d, 7.0F);
  for (const auto site : nearest_sites(none).values) EXPECT_EQ(site, kNoSite);
}

TYPED_TEST(Distance, ToPatchesIsExactNearThemAndErrsUpwardsByLessThanADiagonal) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> window = odd_window<Dim>();
  Random random(5);
  std::vector<Patch<Dim>> patches;
  for (int k = 0; k < 4; ++k) {
    patches.push_back(point_patch<Dim>(random_place(window.bounds(), random)));
    patches.push_back(segment_patch<Dim>(random_place(window.bounds(), random), random_place(window.bounds(), random)));
  }
  const double diagonal = std::sqrt(double{Dim}) * window.spacing;
  const Field<Dim> d = distance_to_patches<Dim>(patches, window);
  for (std::size_t i = 0; i < d.values.size(); ++i) {
    double nearest = kInfinity;
    for (const auto& patch : patches) nearest = std::min(nearest, distance(patch, window.position(i)));
    if (nearest < 0.5 * diagonal) {
      ASSERT_FLOAT_EQ(d[i], static_cast<float>(nearest));
    }
    ASSERT_GE(d[i], static_cast<float>(nearest) - 1e-6F);
    ASSERT_LT(d[i], static_cast<float>(nearest + diagonal));
  }
}

TYPED_TEST(Distance, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto set = random_set<Dim>(0.05, 9);
  std::vector<std::vector<float>> results;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    results.push_back(distance_to_set(set).values);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace vantage
