// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/storey_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "vantage/base/error.h"

namespace vantage {
namespace {

/// Runs `check(plan, options)` on storeys of many sizes and shapes.
template <class Check>
void for_many_storeys(const Check& check) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    StoreyOptions options;
    options.rooms = 12 + static_cast<int>(random.below(149));
    const double area = random.uniform(32.0, 45.0) * options.rooms, aspect = random.uniform(1.0, 2.5);
    const Box<2> inside{Vec<2>::Zero(), Vec<2>(std::sqrt(area * aspect), std::sqrt(area / aspect))};
    check(plan_storey(inside, options, random), options);
  }
}

bool touch(const Box<2>& a, const Box<2>& b) { return !a.grown(1e-6).intersection(b).empty(); }

std::vector<Box<2>> spaces(const StoreyPlan& plan) {
  std::vector<Box<2>> all = plan.rooms;
  all.insert(all.end(), plan.corridors.begin(), plan.corridors.end());
  return all;
}

TEST(StoreyPlan, HasTheRoomsAskedFor) {
  for_many_storeys([](const StoreyPlan& plan, const StoreyOptions& options) {
    EXPECT_GE(static_cast<int>(plan.rooms.size()), options.rooms);
    EXPECT_LE(static_cast<int>(plan.rooms.size()), options.rooms * 3 / 2);
    for (const Box<2>& room : plan.rooms) EXPECT_GE(room.size().minCoeff(), options.min_side - 1e-9);
    for (const Box<2>& corridor : plan.corridors) EXPECT_GE(corridor.size().minCoeff(), 1.9 - 1e-9);
  });
}

TEST(StoreyPlan, RoomsAndCorridorsAreApartByWalls) {
  for_many_storeys([](const StoreyPlan& plan, const StoreyOptions& options) {
    const std::vector<Box<2>> all = spaces(plan);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_TRUE(plan.inside.grown(1e-9).contains(all[i].low) && plan.inside.grown(1e-9).contains(all[i].high));
      for (std::size_t j = 0; j < i; ++j) {
        const bool corridors = j >= plan.rooms.size();  // They may run into each other.
        EXPECT_TRUE(all[i].grown(corridors ? -1e-6 : options.wall - 1e-6).intersection(all[j]).empty()) << i << ' ' << j;
      }
    }
  });
}

TEST(StoreyPlan, EveryRoomAndCorridorIsJoined) {
  for_many_storeys([](const StoreyPlan& plan, const StoreyOptions&) {
    const std::vector<Box<2>> all = spaces(plan);
    std::vector<std::size_t> reached{0};
    std::vector<bool> known(all.size());
    known[0] = true;
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (std::size_t r = 0; r < all.size(); ++r) {
        const Box<2>& here = all[reached[k]];
        const auto through = [&](const Box<2>& door) { return touch(door, here) && touch(door, all[r]); };
        if (known[r] || (!touch(here, all[r]) && std::none_of(plan.doors.begin(), plan.doors.end(), through))) continue;
        known[r] = true;
        reached.push_back(r);
      }
    EXPECT_EQ(reached.size(), all.size());
  });
}

TEST(StoreyPlan, DoorsAreAsWideAsAskedAndLeadFromOneSpaceToAnother) {
  for_many_storeys([](const StoreyPlan& plan, const StoreyOptions& options) {
    const std::vector<Box<2>> all = spaces(plan);
    for (const Box<2>& door : plan.doors) {
      EXPECT_NEAR(door.size().maxCoeff(), options.door, 1e-9);
      EXPECT_NEAR(door.size().minCoeff(), options.wall, 1e-9);
      EXPECT_EQ(std::count_if(all.begin(), all.end(), [&](const Box<2>& space) { return touch(door, space); }), 2);
    }
  });
}

TEST(StoreyPlan, LayoutsDiffer) {
  std::vector<std::size_t> corridors;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const StoreyPlan plan = plan_storey({Vec<2>::Zero(), Vec<2>(60.0, 40.0)}, {}, random);
    if (std::find(corridors.begin(), corridors.end(), plan.corridors.size()) == corridors.end()) corridors.push_back(plan.corridors.size());
  }
  EXPECT_GE(corridors.size(), 3u);
}

TEST(StoreyPlan, RefusesAStoreyThatIsTooSmall) {
  Random random(1);
  EXPECT_THROW(static_cast<void>(plan_storey({Vec<2>::Zero(), Vec<2>(20.0, 10.0)}, {}, random)), Error);
}

}  // namespace
}  // namespace vantage
