// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/draw.h"

#include <gtest/gtest.h>

#include <numeric>

namespace vantage {
namespace {

TEST(Draw, TakesOneFromEachStretchInOrder) {
  std::vector<std::size_t> all(103);
  std::iota(all.begin(), all.end(), std::size_t{7});
  Random random(1);
  for (const std::size_t count : {1, 10, 50, 102}) {
    const std::vector<std::size_t> drawn = draw(all, count, random);
    ASSERT_EQ(drawn.size(), count);
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_GE(drawn[k], 7 + k * 103 / count);
      EXPECT_LT(drawn[k], 7 + (k + 1) * 103 / count);
    }
  }
  EXPECT_EQ(draw(all, 103, random), all);
  EXPECT_EQ(draw(all, 1000, random), all);
}

}  // namespace
}  // namespace vantage
