// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/field/belief_view.h"
#include "vantage/field/distance.h"
#include "vantage/field/redistance.h"

namespace vantage {

inline constexpr double kTestSpacing = 0.25;

/// A belief made by hand: `state_at(position)` says what each node is.
template <int Dim>
struct HandMade {
  Field<Dim, NodeState> state;
  Field<Dim> psi, known_distance;
  ShadowBoundary<Dim> boundary;

  template <class StateAt>
  HandMade(const Box<Dim>& box, StateAt&& state_at, double h = kTestSpacing) : state(window_over(box, h)) {
    for (std::size_t i = 0; i < state.values.size(); ++i) state[i] = state_at(state.window.position(i));
    redistance();
  }
  /// After the states were changed.
  void redistance() {
    Field<Dim, std::uint8_t> seen(state.window), obstacle(state.window);
    for (std::size_t i = 0; i < state.values.size(); ++i) {
      seen[i] = state[i] == NodeState::seen;
      obstacle[i] = state[i] == NodeState::obstacle;
    }
    psi = signed_distance(seen, 8.0);
    known_distance = distance_to_set(obstacle, 8.0);
    boundary = ShadowBoundary<Dim>(state.window);
    for (std::size_t i = 0; i < state.values.size(); ++i) boundary.touch(state.window.local(i));
    boundary.renew(state, psi, state.window);
  }
  [[nodiscard]] BeliefView<Dim> view() const { return {state, psi, known_distance, boundary}; }
};

template <int Dim>
Box<Dim> cube(double half_side) {
  return {Vec<Dim>::Constant(-half_side), Vec<Dim>::Constant(half_side)};
}

template <int Dim>
Vec<Dim> on_axis(double x) {
  Vec<Dim> p = Vec<Dim>::Zero();
  p[0] = x;
  return p;
}

}  // namespace vantage
