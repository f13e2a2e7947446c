// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/base/random.h"
#include "vantage/geometry/box.h"

namespace vantage {

/// How a large storey is divided.
struct StoreyOptions {
  int rooms = 64;         ///< At least.
  double wall = 0.35;     ///< Thickness of all inner walls [m].
  double door = 1.2;      ///< Width of all doors [m].
  double min_side = 2.6;  ///< No room is narrower [m].
  double block = 13.0;    ///< A block of rooms between corridors is at most this deep [m] and half as long again.
};

/// One storey with corridors, seen from above. Corridors that meet do so without a wall or by a door; what lies between them are blocks of rooms
/// (`plan_rooms`), some of which open to a corridor and some only to other rooms. All are joined by the doors.
struct StoreyPlan {
  Box<2> inside;                  ///< Within the outer walls [m].
  std::vector<Box<2>> rooms;      ///< They leave the walls between them.
  std::vector<Box<2>> corridors;  ///< The first one is the longest; one that runs into another touches it, or a door in the wall between.
  std::vector<Box<2>> doors;      ///< Each fills a piece of wall from one room or corridor to another.
};

/// Throws bad_input where `inside` is too small for the rooms (20 m2 each are always enough, above 100 m2).
[[nodiscard]] StoreyPlan plan_storey(const Box<2>& inside, const StoreyOptions& options, Random& random);

}  // namespace vantage
