// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_tour.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// A wall at x = 5 with a gap at y > 8.
Field<2, std::uint8_t> hall() {
  Field<2, std::uint8_t> passable(window_over(Box<2>{{0.0, 0.0}, {10.0, 10.0}}, 0.25), 1);
  for (std::size_t i = 0; i < passable.values.size(); ++i) {
    const Vec<2> p = passable.window.position(i);
    if (std::abs(p[0] - 5.0) < 0.4 && p[1] < 8.0) passable[i] = 0;
  }
  return passable;
}

TEST(NextTours, PassAllStationsOverFreeNodes) {
  const Field<2, std::uint8_t> passable = hall();
  const std::vector<Vec<2>> stations = {{9.0, 1.0}, {1.0, 4.0}, {6.0, 2.0}, {9.0, 9.0}};
  const NextTour<2> tour = tour_past<2>(passable, {1.0, 1.0}, stations);
  EXPECT_EQ(tour.order, (std::vector<std::size_t>{1, 3, 2, 0}));  // The near one on this side first, then through the gap and down.
  EXPECT_GT(tour.length, 3.0 + 9.4 + 7.6 + 3.1);
  EXPECT_LT(tour.length, 30.0);
  for (const Vec<2>& station : stations) {
    double nearest = kInfinity;
    for (const Vec<2>& p : tour.path) nearest = std::min(nearest, (p - station).norm());
    EXPECT_EQ(nearest, 0.0);
  }
  for (std::size_t i = 1; i < tour.path.size(); ++i)
    for (double t = 0.0; t <= 1.0; t += 0.1) {
      const Vec<2> p = tour.path[i - 1] + t * (tour.path[i] - tour.path[i - 1]);
      EXPECT_NE(passable.at(passable.window.nearest(p)), 0) << p.transpose();
    }
}

TEST(NextTours, NoStationsNoWay) {
  const NextTour<2> tour = tour_past<2>(hall(), {1.0, 1.0}, {});
  EXPECT_TRUE(tour.order.empty());
  EXPECT_EQ(tour.length, 0.0);
}

}  // namespace
}  // namespace vantage
