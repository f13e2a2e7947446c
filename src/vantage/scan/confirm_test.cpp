// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/confirm.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"

namespace vantage {
namespace {

template <class T>
class Confirm : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Confirm, Dims);

/// In the middle of a ball of 10 m; in the plane, of a disc.
template <int Dim>
Scan<Dim> round_room() {
  Scan<Dim> scan;
  scan.pattern.step = radians(2.0);
  scan.ranges.assign(static_cast<std::size_t>(scan.pattern.columns() * scan.pattern.template rows<Dim>()), 10.0F);
  return scan;
}

TYPED_TEST(Confirm, StraysGoAndWallsStay) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = round_room<Dim>();
  Random random(7);
  std::int64_t strays = 0;
  const auto apart = static_cast<std::size_t>(3 * scan.pattern.template rows<Dim>() + 7);  // None within reach of another, nor across the seam.
  for (std::size_t i = 0; i + apart < scan.ranges.size(); i += apart, ++strays) scan.ranges[i] = static_cast<float>(random.uniform(0.5, 6.0));
  Scan<Dim> filtered = scan;
  EXPECT_GT(strays, 10);
  EXPECT_EQ(drop_unconfirmed(filtered, 0.0), strays);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    EXPECT_TRUE(scan.ranges[i] != 10.0F || filtered.ranges[i] == 10.0F);
    EXPECT_TRUE(!std::isnan(filtered.ranges[i]) || scan.ranges[i] < 6.5F);
  }
}

TYPED_TEST(Confirm, NoiseDropOutAndSlantConfirmOneAnother) {
  constexpr int Dim = TypeParam::value;
  Scan<Dim> scan = round_room<Dim>();
  Random random(8);
  for (float& range : scan.ranges) range = random.uniform() < 0.3 ? kNoData : static_cast<float>(10.0 + 0.05 * random.normal());
  const std::int64_t hits = std::count_if(scan.ranges.begin(), scan.ranges.end(), [](float r) { return std::isfinite(r); });
  // A hit whose neighbours all dropped out: 0.3^4 of them in the plane.
  EXPECT_LT(static_cast<double>(drop_unconfirmed(scan, 0.05)), 0.02 * static_cast<double>(hits));
}

/// In the plane one other is enough, in space it takes three.
TYPED_TEST(Confirm, FewHitsAloneAreDroppedMoreAreNot) {
  constexpr int Dim = TypeParam::value;
  constexpr int kEnough = Dim == 2 ? 2 : 4;
  Scan<Dim> scan = round_room<Dim>();
  std::fill(scan.ranges.begin(), scan.ranges.end(), kNoReturn);
  const int rows = scan.pattern.template rows<Dim>(), row = rows / 2, last = scan.pattern.columns() - 1;
  const auto at = [&](int c, int r) -> float& { return scan.ranges[static_cast<std::size_t>(c * rows + r)]; };
  const auto set = [&](int count, float beside) {  // Every second one on the other side of the seam.
    for (int k = 0; k < count; ++k) at(k % 2 == 0 ? 0 : last, row + k / 2) = k % 2 == 0 ? 3.0F : beside;
  };
  for (int count = 1; count < kEnough; ++count) {
    set(count, 3.1F);
    EXPECT_EQ(drop_unconfirmed(scan, 0.0), count);
    EXPECT_TRUE(std::isnan(at(0, row)));
  }
  set(kEnough, 3.1F);
  EXPECT_EQ(drop_unconfirmed(scan, 0.0), 0);
  set(kEnough, 5.0F);
  EXPECT_EQ(drop_unconfirmed(scan, 0.0), kEnough);
  set(kEnough, 3.1F);
  scan.pattern.horizontal_fov = radians(300.0);  // Now they are the two ends.
  scan.ranges.resize(static_cast<std::size_t>(scan.pattern.columns() * rows));
  EXPECT_EQ(drop_unconfirmed(scan, 0.0), (kEnough + 1) / 2);
}

}  // namespace
}  // namespace vantage
