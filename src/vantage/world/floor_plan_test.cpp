// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/floor_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vantage {
namespace {

/// Runs `check(plan, options)` on plans of many sizes.
template <class Check>
void for_many_plans(const Check& check) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    FloorPlanOptions options;
    options.rooms = 1 + static_cast<int>(seed % 7);
    const Box<2> inside{Vec<2>(0.0, 0.0), Vec<2>(random.uniform(4.0, 14.0), random.uniform(4.0, 12.0))};
    check(plan_rooms(inside, options, random), options);
  }
}

bool touch(const Box<2>& a, const Box<2>& b) { return !a.grown(1e-6).intersection(b).empty(); }

TEST(FloorPlan, RoomsAreWideEnoughAndApartByWalls) {
  int most = 0;
  for_many_plans([&](const FloorPlan& plan, const FloorPlanOptions& options) {
    most = std::max(most, static_cast<int>(plan.rooms.size()));
    EXPECT_LE(static_cast<int>(plan.rooms.size()), options.rooms);
    for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
      EXPECT_GE(plan.rooms[i].size().minCoeff(), options.min_side - 1e-9);
      EXPECT_TRUE(plan.inside.grown(1e-9).contains(plan.rooms[i].low) && plan.inside.grown(1e-9).contains(plan.rooms[i].high));
      for (std::size_t j = 0; j < i; ++j) EXPECT_TRUE(plan.rooms[i].grown(options.wall - 1e-6).intersection(plan.rooms[j]).empty());
    }
  });
  EXPECT_GE(most, 5);
}

TEST(FloorPlan, DoorsJoinAllRoomsAndAreAsWideAsAsked) {
  for_many_plans([](const FloorPlan& plan, const FloorPlanOptions& options) {
    ASSERT_EQ(plan.doors.size() + 1, plan.rooms.size());  // A tree, if every door joins two rooms and all are reached.
    std::vector<std::size_t> reached{0};
    std::vector<bool> known(plan.rooms.size());
    known[0] = true;
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (const Box<2>& door : plan.doors)
        for (std::size_t r = 0; r < plan.rooms.size(); ++r)
          if (!known[r] && touch(door, plan.rooms[reached[k]]) && touch(door, plan.rooms[r])) {
            known[r] = true;
            reached.push_back(r);
          }
    EXPECT_EQ(reached.size(), plan.rooms.size());
    for (const Box<2>& door : plan.doors) {
      EXPECT_NEAR(door.size().maxCoeff(), options.door, 1e-9);
      EXPECT_NEAR(door.size().minCoeff(), options.wall, 1e-9);
    }
  });
}

TEST(FloorPlan, WindowsPierceTheOuterWallOfOneRoomAndLeaveEntrancesAlone) {
  for_many_plans([](const FloorPlan& plan, const FloorPlanOptions& options) {
    const std::vector<Box<2>> entrances{entrance(plan, false, options), entrance(plan, true, options)};
    for (const Box<2>& door : entrances) EXPECT_NEAR(door.size()[0], options.door, 1e-9);
    for (const Box<2>& window : windows(plan, entrances, options)) {
      EXPECT_EQ(std::count_if(plan.rooms.begin(), plan.rooms.end(), [&](const Box<2>& room) { return touch(window, room); }), 1);
      EXPECT_TRUE(plan.inside.grown(-1e-6).intersection(window).empty());
      EXPECT_NEAR(window.size().maxCoeff(), options.window, 1e-9);
      for (const Box<2>& door : entrances) EXPECT_TRUE(door.grown(0.2).intersection(window).empty());
    }
  });
}

}  // namespace
}  // namespace vantage
