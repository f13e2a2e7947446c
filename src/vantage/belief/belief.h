// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "vantage/belief/block_values.h"
#include "vantage/field/belief_view.h"
#include "vantage/field/seen_set.h"

namespace vantage {

/// Everything seen so far (paper Sec. III-A: psi <- max(psi, phi), then redistance). The union never forgets; it is kept on the sign.
template <int Dim>
  requires SpatialDim<Dim>
class Belief {
 public:
  /// Nothing seen over `window`. `eta` is the surface's tolerance; distances to the known surface are told apart up to `known_cap`, or twice the
  /// spacing or obstacle_distance() if these are more [m]. Throws memory if the lattice does not fit.
  Belief(const Grid<Dim>& window, double eta, double known_cap = 0.0);

  /// Adds what one scan saw. `known`: distance to the known surface as it is now, on the window of `seen`, exact up to known_cap() [m].
  /// State, psi and boundary are renewed where something has changed, and within cap() of that; the rest stays as it was.
  /// `walls`: points on surfaces known between the scan's rays, at most h/2 apart (scan/fill.h); they count for the known distance too, for good.
  void unite(const SeenSet<Dim>& seen, const Field<Dim>& known, std::span<const Vec<Dim>> walls = {});

  [[nodiscard]] BeliefView<Dim> view() const { return {state_, psi_, known_distance_, boundary_}; }
  /// Nodes ever seen, obstacles among them or not.
  [[nodiscard]] const SeenSet<Dim>& ever_seen() const { return seen_; }
  /// Memory of what is kept from step to step: the nodes ever seen, the walls between rays, the shadow boundary. The fields of the view are made
  /// from the first two and the surface.
  [[nodiscard]] std::size_t kept_bytes() const { return seen_.bytes() + wall_distance_.bytes() + boundary_.bytes(); }
  [[nodiscard]] double seen_volume() const;  ///< Of nodes in state seen [m^Dim].
  /// Nodes no farther than this from the known surface are obstacle: max(eta, sqrt(Dim) h / 2), so that no wall slips between nodes [m].
  [[nodiscard]] double obstacle_distance() const { return obstacle_distance_; }
  [[nodiscard]] double cap() const { return cap_; }              ///< psi is exact up to here [m].
  [[nodiscard]] double known_cap() const { return known_cap_; }  ///< The known distance ends here [m].

 private:
  using Walls = BlockValues<Dim>;
  /// What judging found: the smallest window of the nodes whose psi may change.
  struct Change {
    Grid<Dim> nodes;
    std::int64_t seen = 0;  // More than before.
  };

  Grid<Dim> add_walls(std::span<const Vec<Dim>> walls);
  Change judge(const Grid<Dim>& part);
  std::int64_t judge_row(const Grid<Dim>& part, std::size_t row, std::array<std::size_t, 2>& changed);
  Grid<Dim> redistance_around(const Grid<Dim>& changed);

  double obstacle_distance_, cap_, known_cap_;
  SeenSet<Dim> seen_;
  Walls wall_distance_;  // Up to sqrt(Dim) h.
  Field<Dim, NodeState> state_;
  Field<Dim> psi_, known_distance_;
  ShadowBoundary<Dim> boundary_;
  std::int64_t seen_nodes_ = 0;  // In state seen.
};

}  // namespace vantage
