// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/opening.h"

namespace vantage {

// What others do, to compare with: nearest frontier (Yamauchi 1997), greedy frontier count (Burgard et al. 2005), chance.

/// A face counts as frontier from this probability on; if none has it, those that may open at all count [1].
inline constexpr double kFrontierProbability = 0.1;

/// The faces that count as frontier, in groups joined over neighbouring unseen nodes, diagonals included; groups of fewer than Dim faces are left out
/// unless there are no others. In order of the faces.
template <int Dim>
[[nodiscard]] std::vector<BoundaryFace<Dim>> frontier_faces(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces);

struct FrontierPlace {
  std::size_t node = 0;
  double walk = 0.0;  ///< Length of the way there [m].
};

/// The reachable nodes beside `frontier` (within `reach` of a face of it, the least reachable distance if none is so near), not within 2 h of
/// `visited`, with the way from `here`. Nearest first, then by index. Cost: a fast march over all that is reachable.
template <int Dim>
[[nodiscard]] std::vector<FrontierPlace> frontier_places(const Field<Dim, std::uint8_t>& reachable, std::span<const BoundaryFace<Dim>> frontier,
                                                         std::span<const Vec<Dim>> visited, double reach);

/// How many of `frontier` are in line of sight from `z` and within `max_range` [m]. Of more than 1,000, every n-th is asked and counts n times.
template <int Dim>
[[nodiscard]] double frontier_count(std::span<const BoundaryFace<Dim>> frontier, const RayMarch<Dim>& rays, const Vec<Dim>& z, double max_range);

}  // namespace vantage
