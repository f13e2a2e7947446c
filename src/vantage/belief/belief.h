// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "vantage/belief/block_bits.h"
#include "vantage/belief/block_values.h"
#include "vantage/field/belief_view.h"

namespace vantage {

/// Everything seen so far (paper Sec. III-A: psi <- max(psi, phi), then redistance). The union never forgets; it is kept on the sign.
template <int Dim>
  requires SpatialDim<Dim>
class Belief {
 public:
  /// Nothing seen over `window`. `eta` is the surface's tolerance [m]. Throws memory if the lattice does not fit.
  Belief(const Grid<Dim>& window, double eta);

  /// Adds what one scan saw: `phi` as visibility.h gives it, on any window of the same lattice. |phi| also renews the distance to the known surface
  /// there. psi is renewed within its cap of the nodes that became seen or ceased to be, the rest stays as it was.
  /// `walls`: points on surfaces known between the scan's rays, at most h/2 apart (scan/fill.h); they count for the known distance too, for good.
  void unite(const Field<Dim>& phi, std::span<const Vec<Dim>> walls = {});

  [[nodiscard]] BeliefView<Dim> view() const { return {state_, psi_, known_distance_}; }
  /// Nodes ever seen, obstacles among them or not.
  [[nodiscard]] const BlockBits<Dim>& ever_seen() const { return seen_; }
  /// Memory of what the view is made from and cannot be had from it: the nodes ever seen and the walls between rays.
  [[nodiscard]] std::size_t kept_bytes() const { return seen_.bytes() + wall_distance_.bytes(); }
  [[nodiscard]] double seen_volume() const;  ///< Of nodes in state seen [m^Dim].
  /// Nodes no farther than this from the known surface are obstacle: max(eta, sqrt(Dim) h / 2), so that no wall slips between nodes [m].
  [[nodiscard]] double obstacle_distance() const { return obstacle_distance_; }
  /// psi and the known distance are exact up to here [m].
  [[nodiscard]] double cap() const { return cap_; }

 private:
  using Walls = BlockValues<Dim>;

  Grid<Dim> add_walls(std::span<const Vec<Dim>> walls);
  Grid<Dim> judge(const Grid<Dim>& part);
  void redistance_around(const Grid<Dim>& changed);

  double eta_, obstacle_distance_, cap_;
  BlockBits<Dim> seen_;
  Walls wall_distance_;  // Up to sqrt(Dim) h.
  Field<Dim, NodeState> state_;
  Field<Dim> psi_, known_distance_;
};

}  // namespace vantage
