// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/geometry/ray_caster.h"

namespace vantage {

/// What a first vantage point needs.
struct StartNeeds {
  double clearance = 0.5;  ///< [m]
  double range = 80.0;     ///< Of the sensor [m].
};

/// A good first place in a world nobody has described: of 24 x 24 columns over the domain those are looked at where a scanner can stand, 1.7 m above
/// the lowest surface (1.1 times the clearance if that is more, half the domain's height if that is less), clear of surfaces and not within a solid.
/// Among them the one whose level rays are longest on average, those without a return counting nothing and the middle of the domain up to twice its
/// rim: streets before open fields, corridors before cupboards, outdoors before within a house. If there is no such column: the freest place of a
/// coarse lattice in mid-air; if none, the centre, where the sensor will complain. Deterministic.
[[nodiscard]] Vec<3> find_start(const RayCaster<3>& world, const Box<3>& domain, const StartNeeds& needs);

/// Height of the ground: where most of the columns over `bounds` meet their lowest surface (half of the columns within 0.25 m of the median);
/// `bounds.low[2]` if there is no such level.
[[nodiscard]] double ground_level(const RayCaster<3>& world, const Box<3>& bounds);

}  // namespace vantage
