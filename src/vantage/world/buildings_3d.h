// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/base/random.h"
#include "vantage/world/placement.h"
#include "vantage/world/scenery.h"

namespace vantage {

// Buildings stand in their own frame with the front along the first axis at y = 0, the ground at z = 0, and look towards -y. Walls are solid,
// interiors are open to doors and windows, roofs are solid. Doors are 1.8 m wide or wider and 2.2 m high or higher.

/// A house with rooms.
struct House {
  enum class Roof { flat, gable, gable_to_street, hip };
  double width = 10.0, depth = 8.0;  ///< Outer [m].
  int storeys = 1;                   ///< Each 3 m high; a stairwell joins them.
  int rooms = 3;                     ///< At most, on each storey.
  Roof roof = Roof::gable;
  bool annex = false;  ///< One-room building of 4 m on the right.
  bool court = false;  ///< Walled yard with a gate behind, and a back door into it.
};
inline constexpr double kAnnexWidth = 4.0;  ///< [m]
inline constexpr double kCourtDepth = 7.0;  ///< [m]

/// Adds "house", "roof", "stair" and, for a court, "wall".
void add_house(Scenery<3>& scenery, const Placement<3>& place, const House& house, Random& random);

/// Adds a hall of 24 x 13 x 8 m with wide gates, a corner office and a row of posts: "house", "roof", "column".
void add_hall(Scenery<3>& scenery, const Placement<3>& place);

/// Adds a church of 12 x 37 m about the second axis: tower of 20 m with an open belfry, nave with two rows of columns and pews, chancel.
/// Kinds "church", "roof", "column", "furniture".
void add_church(Scenery<3>& scenery, const Placement<3>& place);
inline constexpr double kChurchLength = 37.0, kChurchWidth = 12.0;  ///< [m]

/// Adds a free-standing wall along the border of `yard` with openings (seen from above) in it.
void add_yard_wall(Scenery<3>& scenery, const Placement<3>& place, const Box<2>& yard, double height, const std::vector<Box<2>>& openings);

}  // namespace vantage
