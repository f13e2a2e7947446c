// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/opening.h"
#include "vantage/planner/planner_options.h"

namespace vantage {

/// Nodes a vantage point may be moved to from `from`: seen, at `clearance` from the known surface, joined to `from` through such nodes (1, else 0).
/// Where `from` itself has less clearance, as a start may, any seen node near it will do.
template <int Dim>
[[nodiscard]] Field<Dim, std::uint8_t> reachable_nodes(const BeliefView<Dim>& view, const Vec<Dim>& from, double clearance);

/// Which of the `allowed` nodes beside `from` a way begins with: the nearest one with no known surface between, as the known distances of both ends
/// add up to more than the step; the nearest if there is no such one; kNoNode if none is beside it.
template <int Dim>
[[nodiscard]] std::size_t first_node(const BeliefView<Dim>& view, const Vec<Dim>& from, const std::function<bool(std::size_t)>& allowed);

/// Medial nodes of the seen space among the reachable ones: -lap(psi) > M/h, psi > 0.6 h, off the known surface, not within 2 h of `visited`. In
/// order of their index. If there are none: all reachable nodes but those near `visited`.
template <int Dim>
[[nodiscard]] std::vector<std::size_t> medial_nodes(const BeliefView<Dim>& view, const Field<Dim, std::uint8_t>& reachable,
                                                    std::span<const Vec<Dim>> visited, const PlannerOptions& options);

/// At most `limit` of `nodes`: two fifths at random, the rest aimed at the faces most likely to open, from in front of them and in line of sight
/// (planner.md Sec. 4). In order of their index, none twice.
template <int Dim>
[[nodiscard]] std::vector<std::size_t> choose_candidates(std::span<const std::size_t> nodes, std::span<const BoundaryFace<Dim>> faces,
                                                         const RayMarch<Dim>& rays, const Grid<Dim>& grid, std::size_t limit, std::uint64_t seed);

}  // namespace vantage
