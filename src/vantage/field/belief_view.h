// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/field/shadow_boundary.h"

namespace vantage {

inline constexpr std::size_t kNoNode = static_cast<std::size_t>(-1);

/// What the belief shows the planner. Everything lives on one window over the domain; outside of it there is nothing to see.
template <int Dim>
  requires SpatialDim<Dim>
struct BeliefView {
  const Field<Dim, NodeState>& state;
  const Field<Dim>& psi;             ///< Signed distance to the occlusion set's boundary, > 0 where seen, capped [m].
  const Field<Dim>& known_distance;  ///< To the known surface, capped [m].
  const ShadowBoundary<Dim>& boundary;

  [[nodiscard]] const Grid<Dim>& window() const { return state.window; }
  [[nodiscard]] bool seen(std::size_t node) const { return state[node] == NodeState::seen; }
};

}  // namespace vantage
