// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/narrow_band.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/field/redistance.h"

namespace vantage {
namespace {

template <class T>
class NarrowBandOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(NarrowBandOf, Dimensions);

/// Balls that touch each other and the sides.
template <int Dim>
Field<Dim, std::uint8_t> balls(int count) {
  Field<Dim, std::uint8_t> set(Grid<Dim>{0.2, Index<Dim>::Constant(-9), Index<Dim>::Constant(75)});
  Random random(4);
  for (int k = 0; k < count; ++k) {
    Vec<Dim> center;
    for (int a = 0; a < Dim; ++a) center[a] = random.uniform(-2.0, 13.0);
    const double radius = random.uniform(0.1, 2.0);
    for (std::size_t i = 0; i < set.values.size(); ++i)
      if ((set.window.position(i) - center).norm() < radius) set[i] = 1;
  }
  return set;
}

TYPED_TEST(NarrowBandOf, IsTheSignedDistanceThereAndNothingElse) {
  constexpr int Dim = TypeParam::value;
  for (const int count : {0, 1, 12})
    for (const double reach : {0.05, 0.15, 0.8, 3.2}) {
      const auto set = balls<Dim>(count);
      const Field<Dim> psi = signed_distance(set, 10.0);
      const NarrowBand band = narrow_band(set, reach);
      std::size_t expected = 0;
      for (const float d : psi.values) expected += std::abs(d) < static_cast<float>(reach);
      ASSERT_EQ(band.nodes.size(), expected);
      std::vector<bool> met(psi.values.size());
      for (std::size_t k = 0; k < expected; ++k) {
        ASSERT_EQ(band.distances[k], psi[band.nodes[k]]);
        ASSERT_FALSE(met[band.nodes[k]]);
        met[band.nodes[k]] = true;
      }
    }
}

TYPED_TEST(NarrowBandOf, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto set = balls<Dim>(5);
  std::vector<NarrowBand> bands;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    bands.push_back(narrow_band(set, 0.8));
  }
  EXPECT_EQ(bands[0].nodes, bands[1].nodes);
  EXPECT_EQ(bands[0].distances, bands[1].distances);
}

TYPED_TEST(NarrowBandOf, RefusesWhatIsNoBand) {
  constexpr int Dim = TypeParam::value;
  EXPECT_THROW((void)narrow_band(balls<Dim>(1), 0.0), Error);
  EXPECT_THROW((void)narrow_band(balls<Dim>(1), 20.0), Error);
}

}  // namespace
}  // namespace vantage
