// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/angle.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"

namespace vantage {
namespace {

TEST(Angle, SinCosAgreesWithLibm) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double angle = random.uniform(-10.0, 10.0);
    const auto [s, c] = sin_cos(angle);
    EXPECT_NEAR(s, std::sin(angle), 2e-15);
    EXPECT_NEAR(c, std::cos(angle), 2e-15);
  }
}

TEST(Angle, MultiplesOfARightAngleAreClean) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const auto [s, c] = sin_cos(radians(90.0 * quarter));
    const int turn = ((quarter % 4) + 4) % 4;
    EXPECT_NEAR(s, turn == 1 ? 1.0 : turn == 3 ? -1.0 : 0.0, 1e-15);
    EXPECT_NEAR(c, turn == 0 ? 1.0 : turn == 2 ? -1.0 : 0.0, 1e-15);
  }
  EXPECT_EQ(sin_cos(0.0)[0], 0.0);
  EXPECT_EQ(sin_cos(0.0)[1], 1.0);
}

TEST(Angle, DegreesAndBack) {
  EXPECT_DOUBLE_EQ(radians(180.0), kPi);
  EXPECT_DOUBLE_EQ(degrees(radians(0.5)), 0.5);
}

}  // namespace
}  // namespace vantage
