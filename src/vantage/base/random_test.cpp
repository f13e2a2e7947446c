// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace vantage {
namespace {

TEST(Random, SameSeedSameDraws) {
  Random a(7, 3), b(7, 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
}

TEST(Random, SeedsAndStreamsDiffer) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    for (std::uint64_t stream = 0; stream < 50; ++stream) first.insert(Random(seed, stream).next());
  EXPECT_EQ(first.size(), 2500U);
}

TEST(Random, UniformFillsItsInterval) {
  Random random(1);
  std::array<int, 10> bins{};
  double sum = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double x = random.uniform(-2.0, 3.0);
    ASSERT_GE(x, -2.0);
    ASSERT_LT(x, 3.0);
    sum += x;
    ++bins[static_cast<std::size_t>((x + 2.0) * 2.0)];
  }
  EXPECT_NEAR(sum / 1e5, 0.5, 0.02);
  for (const int bin : bins) EXPECT_NEAR(bin, 10000, 500);
}

TEST(Random, BelowIsEven) {
  Random random(2);
  std::array<int, 7> bins{};
  for (int i = 0; i < 70000; ++i) ++bins.at(random.below(7));
  for (const int bin : bins) EXPECT_NEAR(bin, 10000, 500);
  EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, NormalHasUnitVariance) {
  Random random(3);
  double sum = 0.0, sum2 = 0.0;
  int beyond = 0;
  for (int i = 0; i < 100000; ++i) {
    const double x = random.normal();
    ASSERT_LE(std::abs(x), 6.0);
    sum += x;
    sum2 += x * x;
    beyond += std::abs(x) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / 1e5, 0.0, 0.015);
  EXPECT_NEAR(sum2 / 1e5, 1.0, 0.02);
  EXPECT_NEAR(beyond / 1e5, 0.0455, 0.006);
}

}  // namespace
}  // namespace vantage
