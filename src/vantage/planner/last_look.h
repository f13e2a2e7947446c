// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "vantage/planner/opening.h"

namespace vantage {

inline constexpr std::size_t kNoNode = static_cast<std::size_t>(-1);

/// Nobody has looked at the face frontally yet: whatever is expected of it, it may open.
template <int Dim>
[[nodiscard]] bool in_doubt(const BoundaryFace<Dim>& face);

/// Length of the unseen straight behind a face, at most `limit` [m].
template <int Dim>
[[nodiscard]] double depth_behind(const BeliefView<Dim>& view, const BoundaryFace<Dim>& face, double limit);

/// What a run still has to look at before it may end.
struct LastLook {
  std::vector<std::size_t> viewer;   ///< Of every face: a node that can be reached and sees it, the best of those tried; kNoNode where no doubt is left or
                                     ///< there is none.
  std::optional<std::size_t> place;  ///< The node from where most may open.
  double volume = 0.0;               ///< At most, from there [m^Dim].
};

/// Where one may stand, and where one stood.
template <int Dim>
struct Ground {
  const Field<Dim, std::uint8_t>& reachable;
  std::span<const Vec<Dim>> visited;
  double max_range = 80.0;  ///< Of the sensor [m].
};

/// Seen nodes that someone with the clearance might get to although no node of the lattice leads there: known places half a step apart are tried, with
/// the distance to the surface that their nodes allow. The reachable nodes are among them (1, else 0).
template <int Dim>
[[nodiscard]] Field<Dim, std::uint8_t> squeezed_nodes(const BeliefView<Dim>& view, const Field<Dim, std::uint8_t>& reachable, double clearance);

/// Tries the faces in doubt from the reachable nodes that are new (all of both if they are few, else an even choice): in range, through seen space,
/// as frontal as the planner learns from. Cost: at most 600,000 lines of sight.
template <int Dim>
[[nodiscard]] LastLook last_look(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const RayMarch<Dim>& rays,
                                 const Ground<Dim>& ground);

}  // namespace vantage
