// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/base/random.h"
#include "vantage/geometry/box.h"

namespace vantage {

/// How a storey is divided and opened.
struct FloorPlanOptions {
  int rooms = 3;          ///< At most; fewer where they would get too narrow.
  double wall = 0.3;      ///< Thickness of all walls [m].
  double door = 1.8;      ///< Width of all doors [m].
  double window = 1.4;    ///< Width of all windows [m].
  double min_side = 2.6;  ///< No room is narrower [m].
};

/// Rectangular rooms with walls between them, all joined by doors; seen from above, in the house's own frame.
struct FloorPlan {
  Box<2> inside;              ///< Within the outer walls [m].
  std::vector<Box<2>> rooms;  ///< They leave the inner walls between them.
  std::vector<Box<2>> doors;  ///< Each fills an inner wall from room to room; the rooms form a tree by them.
};
[[nodiscard]] FloorPlan plan_rooms(const Box<2>& inside, const FloorPlanOptions& options, Random& random);

/// Openings through the outer walls, one or two on each outer side of each room that is wide enough, and none next to an entrance.
[[nodiscard]] std::vector<Box<2>> windows(const FloorPlan& plan, std::span<const Box<2>> entrances, const FloorPlanOptions& options);

/// Opening through the outer wall on the low (front) or high (back) side of the second axis, in the middle of the widest room there.
[[nodiscard]] Box<2> entrance(const FloorPlan& plan, bool back, const FloorPlanOptions& options);

}  // namespace vantage
