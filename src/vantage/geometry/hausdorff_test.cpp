// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/hausdorff.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"
#include "vantage/geometry/disc_cover.h"

namespace vantage {
namespace {

template <int Rank>
using Place = typename ConvexRegion<Rank>::Place;

template <int Rank>
Place<Rank> anywhere(Random& random, double half) {
  Place<Rank> p;
  for (int k = 0; k < Rank; ++k) p[k] = random.uniform(-half, half);
  return p;
}

template <int Rank>
void add(Feet<Rank>& feet, const Place<Rank>& p, double height) {
  for (int k = 0; k < Rank; ++k) feet.at[k].push_back(p[k]);
  feet.height2.push_back(height * height);
}

template <int Rank>
double nearest(const Feet<Rank>& feet, const Place<Rank>& p) {
  double least = kInfinity;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    double d2 = feet.height2[i];
    for (int k = 0; k < Rank; ++k) d2 += (feet.at[k][i] - p[k]) * (feet.at[k][i] - p[k]);
    least = std::min(least, d2);
  }
  return std::sqrt(least);
}

/// Largest distance of a dense sample of the region, with the error that is left at most: the truth lies in [first, first + second].
template <int Rank>
std::pair<double, double> sampled_radius(const ConvexRegion<Rank>& region, const Feet<Rank>& feet, int steps) {
  Place<Rank> low = region.vertices[0], high = low;
  for (int i = 0; i < region.count; ++i) {
    low = low.cwiseMin(region.vertices[i]);
    high = high.cwiseMax(region.vertices[i]);
  }
  double worst = 0.0;
  std::array<int, Rank> at{};
  for (;;) {
    Place<Rank> p;
    for (int k = 0; k < Rank; ++k) p[k] = low[k] + (high[k] - low[k]) * at[k] / steps;
    worst = std::max(worst, nearest<Rank>(feet, region.closest(p)));  // Places outside move onto the border; that spreads them no farther.
    int k = 0;
    while (k < Rank && at[k] == steps) at[k++] = 0;
    if (k == Rank) break;
    ++at[k];
  }
  return {worst, 0.5 * ((high - low) / steps).norm()};
}

template <int Rank>
ConvexRegion<Rank> random_region(Random& random) {
  const Place<Rank> half = Place<Rank>::Constant(1.0) + anywhere<Rank>(random, 0.8);
  ConvexRegion<Rank> region = ConvexRegion<Rank>::box(-half, half);
  for (int cuts = static_cast<int>(random.below(5)); cuts > 0; --cuts) {
    const Place<Rank> normal = anywhere<Rank>(random, 1.0).normalized();
    region = region.clipped(normal, random.uniform(0.1, 1.5));
  }
  return region;
}

template <class T>
class Covering : public ::testing::Test {};
using Ranks = ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>>;
TYPED_TEST_SUITE(Covering, Ranks);

TYPED_TEST(Covering, RadiusIsWithinTenPerCentOfTheTruth) {
  constexpr int Rank = TypeParam::value;
  Random random(1);
  for (const int count : {1, 3, 20, 120, 400, 2000})
    for (int trial = 0; trial < 12; ++trial) {
      const auto region = random_region<Rank>(random);
      Feet<Rank> feet;
      for (int i = 0; i < count; ++i) add<Rank>(feet, anywhere<Rank>(random, 2.0), trial % 2 == 0 ? 0.0 : random.uniform(0.0, 0.2));
      const auto [truth, error] = sampled_radius<Rank>(region, feet, Rank == 1 ? 4000 : 100);
      for (const double limit : {kInfinity, 10.0}) {
        const auto radius = covering_radius<Rank>(region, feet, limit);
        ASSERT_TRUE(radius);
        EXPECT_GE(*radius, truth);
        EXPECT_LE(*radius, 1.1 * (truth + error) + 1e-4);
      }
    }
}

TYPED_TEST(Covering, DecidesOnBothSidesOfTheTruth) {
  constexpr int Rank = TypeParam::value;
  Random random(2);
  for (const int count : {4, 60, 1000})
    for (int trial = 0; trial < 20; ++trial) {
      const auto region = random_region<Rank>(random);
      Feet<Rank> feet;
      for (int i = 0; i < count; ++i) add<Rank>(feet, anywhere<Rank>(random, 2.0), random.uniform(0.0, 0.1));
      // Bisect the decision itself: it must be one threshold, and the sampled truth must be at it.
      double low = 0.0, high = 8.0;
      for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        const auto radius = covering_radius<Rank>(region, feet, middle);
        EXPECT_LE(radius.value_or(0.0), middle);
        (radius ? high : low) = middle;
      }
      const auto [truth, error] = sampled_radius<Rank>(region, feet, Rank == 1 ? 4000 : 100);
      EXPECT_GE(high, truth * (1.0 - 1e-9));
      EXPECT_LE(high, (truth + error) * (1.0 + 1e-5));
    }
}

TEST(Discs, FindAGapExactlyWhereThereIsOne) {
  Random random(5);
  int gaps = 0, covered = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const auto region = random_region<2>(random);
    Feet<2> feet;
    if (trial % 4 == 0) {  // A lattice: many circles cross in one place.
      for (int i = -5; i <= 5; ++i)
        for (int j = -5; j <= 5; ++j)
          if (feet.size() < 64) add<2>(feet, Place<2>(0.35 * i, 0.35 * j), 0.0);
    } else {
      for (int i = 0; i < 4 + trial % 60; ++i) add<2>(feet, anywhere<2>(random, 2.0), random.uniform(0.0, 0.1));
    }
    const auto [truth, error] = sampled_radius<2>(region, feet, 60);
    for (const double limit : {0.7 * truth, 0.99 * truth, truth + error, 1.4 * (truth + error)}) {
      const auto gap = find_uncovered(region, feet, limit * (1.0 + 1e-5));
      EXPECT_EQ(gap.has_value(), limit < truth) << trial;
      if (gap) {
        EXPECT_GE(nearest<2>(feet, *gap), limit * (1.0 - 1e-5));
        EXPECT_LE((region.closest(*gap) - *gap).norm(), 1e-9);
      }
      ++(gap ? gaps : covered);
    }
  }
  EXPECT_GT(gaps, 500);
  EXPECT_GT(covered, 500);
}

/// Clipping leaves corners that rounding alone keeps apart; the edge between them runs anywhere, and bounds nothing.
TEST(CornersThatAreOne, BoundNothing) {
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    ConvexRegion<2> plain, doubled;
    const int corners = 3 + static_cast<int>(random.below(4));
    for (int i = 0; i < corners; ++i) {
      const auto [sine, cosine] = sin_cos((i + 0.8 * random.uniform()) * 2.0 * kPi / corners);
      const Place<2> corner(cosine, sine);
      plain.vertices[plain.count++] = doubled.vertices[doubled.count++] = corner;
      if (i % 2 == 0) doubled.vertices[doubled.count++] = corner + Place<2>(random.uniform(-1e-16, 1e-16), random.uniform(-1e-16, 1e-16));
    }
    Feet<2> feet;
    for (int i = 0; i < 20; ++i) add<2>(feet, Place<2>(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)), 0.1);
    const auto radius = covering_radius<2>(doubled, feet, 10.0);
    ASSERT_TRUE(radius);
    for (int i = 0; i < 2000; ++i) {
      Place<2> p(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
      EXPECT_LT((doubled.closest(p) - plain.closest(p)).norm(), 1e-12);
      EXPECT_NEAR(RegionEdges<2>(doubled).outside(p), RegionEdges<2>(plain).outside(p), 1e-12);
      p = plain.closest(p);
      EXPECT_LE(nearest<2>(feet, p), *radius * (1.0 + 1e-9));
    }
  }
}

TYPED_TEST(Covering, ClosedForms) {
  constexpr int Rank = TypeParam::value;
  Feet<Rank> one;
  add<Rank>(one, Place<Rank>::Zero(), 0.0);
  const auto box = ConvexRegion<Rank>::box(Place<Rank>::Constant(-3.0), Place<Rank>::Constant(3.0));
  const double truth = 3.0 * std::sqrt(static_cast<double>(Rank));
  EXPECT_GE(covering_radius<Rank>(box, one, kInfinity).value(), truth * (1.0 - 1e-12));
  EXPECT_LE(covering_radius<Rank>(box, one, kInfinity).value(), 1.1 * truth);
  EXPECT_FALSE(covering_radius<Rank>(box, one, truth * 0.999999));
  EXPECT_TRUE(covering_radius<Rank>(box, one, truth * 1.00001));

  Feet<Rank> raised;
  add<Rank>(raised, Place<Rank>::Zero(), 4.0);
  EXPECT_NEAR(covering_radius<Rank>(ConvexRegion<Rank>::box(Place<Rank>::Zero(), Place<Rank>::Zero()), raised, 5.0).value(), 4.0, 1e-5);

  EXPECT_EQ(covering_radius<Rank>(ConvexRegion<Rank>{}, one, 1.0), 0.0);  // Nothing to cover.
  EXPECT_FALSE(covering_radius<Rank>(box, Feet<Rank>{}, kInfinity));      // Nothing covers it.
}

TYPED_TEST(Covering, AHoleInManyPointsIsFound) {
  constexpr int Rank = TypeParam::value;
  Random random(3);
  Feet<Rank> feet;
  const Place<Rank> hole = Place<Rank>::Constant(0.37);
  while (feet.size() < 20000) {
    const Place<Rank> p = anywhere<Rank>(random, 1.0);
    if ((p - hole).norm() > 0.1) add<Rank>(feet, p, 0.0);
  }
  const auto region = ConvexRegion<Rank>::box(Place<Rank>::Constant(-1.0), Place<Rank>::Constant(1.0));
  EXPECT_FALSE(covering_radius<Rank>(region, feet, 0.099));
  const auto radius = covering_radius<Rank>(region, feet, 0.13);
  ASSERT_TRUE(radius);
  EXPECT_GE(*radius, 0.1);
}

TYPED_TEST(Covering, OutlineHoldsTheFeet) {
  constexpr int Rank = TypeParam::value;
  Random random(4);
  for (int count = 1; count < 40; ++count) {
    Feet<Rank> feet;
    for (int i = 0; i < count; ++i) add<Rank>(feet, anywhere<Rank>(random, 1.0), 0.0);
    const auto region = outline(feet);
    EXPECT_LE(region.count, 8);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      Place<Rank> p;
      for (int k = 0; k < Rank; ++k) p[k] = feet.at[k][i];
      EXPECT_LT((region.closest(p) - p).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace vantage
