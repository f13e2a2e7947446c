// SPDX-License-Identifier: Apache-2.0
// 5 Planner. Where would one see most that is new? Two rooms and a door: seen are the left room and what shows through the door.
#include <fmt/core.h>

#include "vantage/field/distance.h"
#include "vantage/field/redistance.h"
#include "vantage/planner/planner.h"

using namespace vantage;

int main() {
  // A hand-made belief on a lattice of 0.25 m: walls around the left room, with a door 2 m wide in the wall at x = 10.
  const Vec<2> here(2.0, 2.0);
  const Grid<2> window = window_over<2>({{0.0, 0.0}, {20.0, 10.0}}, 0.25);
  Field<2, NodeState> state(window);
  Field<2, std::uint8_t> seen(window), wall(window);
  const auto in_door = [](double y) { return y > 6.0 && y < 8.0; };
  for (std::size_t i = 0; i < window.size(); ++i) {
    const Vec<2> p = window.position(i);
    const double y_at_wall = here.y() + (p.y() - here.y()) * (10.0 - here.x()) / (p.x() - here.x());  // Of the line from here to p.
    wall[i] = p.x() <= 10.0 && (p.x() == 0.0 || p.y() == 0.0 || p.y() == 10.0 || (p.x() == 10.0 && !in_door(p.y())));
    seen[i] = wall[i] == 0 && (p.x() <= 10.0 || in_door(y_at_wall));
    state[i] = wall[i] != 0 ? NodeState::obstacle : seen[i] != 0 ? NodeState::seen : NodeState::unseen;
  }
  const Field<2> psi = signed_distance(seen, 8.0), known_distance = distance_to_set(wall, 8.0);
  ShadowBoundary<2> boundary(window);
  for (std::size_t i = 0; i < window.size(); ++i) boundary.touch(window.local(i));
  boundary.renew(state, psi, window);
  const BeliefView<2> view = {state, psi, known_distance, boundary};

  Planner<2> planner(PlannerOptions{}, 80.0, 1);
  const Decision<2> next = planner.choose(view, here, 95.0);
  const Verdict<2> verdict = planner.assess(view);

  for (int y = window.extent[1] - 1; y >= 0; --y) {
    std::string row;
    for (int x = 0; x < window.extent[0]; ++x) {
      const Index<2> node(x, y);
      const char ground = state.at(node) == NodeState::obstacle ? '#' : state.at(node) == NodeState::seen ? '.' : ' ';
      row += node == window.nearest(here) ? 'x' : node == window.nearest(next.position) ? 'O' : ground;
    }
    fmt::print("{}\n", row);
  }
  fmt::print("x here, O next at ({:.2f}, {:.2f}): best of {} candidates, {:.0f} m2 expected; path of {} points; {:.0f} % seen\n", next.position.x(),
             next.position.y(), next.candidates, next.expected_volume, next.path.size(), 100.0 * verdict.seen_fraction);
  const bool through_the_door = next.position.x() > 9.5;  // From there the right room lies open.
  return next.found && through_the_door && next.expected_volume > 10.0 ? 0 : 1;
}
