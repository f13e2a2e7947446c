// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

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
  /// there. Nodes changed lie in phi's window; psi is renewed in that window grown by its cap, the rest stays as it was.
  /// `walls`: points on surfaces known between the scan's rays, at most h/2 apart (scan/fill.h); they count for the known distance too, for good.
  void unite(const Field<Dim>& phi, std::span<const Vec<Dim>> walls = {});

  [[nodiscard]] BeliefView<Dim> view() const { return {state_, psi_, known_distance_}; }
  /// Nodes ever seen, obstacles among them or not (0 or 1).
  [[nodiscard]] const Field<Dim, std::uint8_t>& ever_seen() const { return seen_; }
  [[nodiscard]] double seen_volume() const;  ///< Of nodes in state seen [m^Dim].
  /// Nodes no farther than this from the known surface are obstacle: max(eta, sqrt(Dim) h / 2), so that no wall slips between nodes [m].
  [[nodiscard]] double obstacle_distance() const { return obstacle_distance_; }
  /// psi and the known distance are exact up to here [m].
  [[nodiscard]] double cap() const { return cap_; }

 private:
  Grid<Dim> add_walls(std::span<const Vec<Dim>> walls);
  void redistance_around(const Grid<Dim>& changed);

  double eta_, obstacle_distance_, cap_;
  Field<Dim, std::uint8_t> seen_;
  Field<Dim, NodeState> state_;
  Field<Dim> psi_, known_distance_, wall_distance_;
};

}  // namespace vantage
