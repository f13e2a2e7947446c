// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vantage/field/belief_view.h"

namespace vantage {

/// Who carries the scanner over the ground. The last axis points up.
struct GroundOptions {
  double height = 1.5;     ///< Of the scanner above the ground [m].
  double clearance = 0.5;  ///< Of the scanner to known surfaces; below it that of the height if this is less [m].
  double step = 0.2;       ///< Highest step up or down [m].
  double slope = 0.6;      ///< Steepest slope, its tangent [1].
};

/// Nodes a scanner on legs may be put at: seen, at `height` (to within a cell) above known ground, all below it seen and free, at `clearance` from
/// the known surfaces, and joined to the ground nearest to `height` below `from`, heights counting four times, over slopes and steps that can be
/// walked (1, else 0). None if no ground is known so within 6 m or twice the height, whichever is more. The ground is where an obstacle node lies
/// below a seen one; its height is good to a small part of a cell, by the distance to the known surface. Nodes that are `closed` cannot be stood at,
/// nor walked through below.
template <int Dim>
[[nodiscard]] Field<Dim, std::uint8_t> walkable_nodes(const BeliefView<Dim>& view, const Vec<Dim>& from, const GroundOptions& options,
                                                      const std::function<bool(const Vec<Dim>&)>& closed = {});

/// Heights of places above the known ground: the median over the columns within a metre or two cells of each or, where none was seen, those within
/// `reach`; infinity where there is none [m].
template <int Dim>
[[nodiscard]] std::vector<double> heights_above_ground(const BeliefView<Dim>& view, std::span<const Vec<Dim>> places, double reach);

/// Height of the ground below a seen place, seen all the way down to it [m]; minus infinity if there is none.
template <int Dim>
[[nodiscard]] double ground_below(const BeliefView<Dim>& view, const Vec<Dim>& place);

}  // namespace vantage
