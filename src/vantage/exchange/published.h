// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "vantage/exchange/cell_table.h"
#include "vantage/exchange/leaves.h"

namespace vantage {

/// Number of a site among all sites of the lattice: in each axis twice its cell's, plus 1 for the centre.
template <int Dim>
[[nodiscard]] CellNumber<Dim> site_number(const CellNumber<Dim>& cell, bool center) {
  CellNumber<Dim> number = cell;
  for (std::uint32_t& n : number) n = 2 * n + (center ? 1 : 0);
  return number;
}
/// Calls `visit(number, distance)` for the sites within `reach` of p, which lies in `cell`; reach is at most that of the lattice.
template <int Dim, class Visit>
void each_site_near(const ExchangeLattice<Dim>& lattice, const Vec<Dim>& p, double reach, Visit&& visit) {
  const std::optional<CellNumber<Dim>> cell = lattice.cell(p);
  if (!cell) return;
  const Vec<Dim> inside = (p - lattice.corner(*cell, 0)) / lattice.spacing;
  const double limit2 = (1.0 + 1e-6) * (reach / lattice.spacing) * (reach / lattice.spacing);
  for (const bool center : {false, true}) {
    CellNumber<Dim> first = *cell;
    std::array<std::array<double, 2>, Dim> apart2;  // Along each axis, to the lower and the upper of two sites, in cells, squared.
    for (unsigned a = 0; a < Dim; ++a) {
      double apart = inside[a];
      if (center) {
        const bool low = apart < 0.5;
        first[a] -= low ? 1U : 0U;
        apart += low ? 0.5 : -0.5;
      }
      apart2[a] = {apart * apart, (apart - 1.0) * (apart - 1.0)};
    }
    for (unsigned k = 0; k < (1U << Dim); ++k) {
      double distance2 = 0.0;
      for (unsigned a = 0; a < Dim; ++a) distance2 += apart2[a][k >> a & 1U];
      if (distance2 > limit2) continue;
      CellNumber<Dim> at = first;
      for (unsigned a = 0; a < Dim; ++a) at[a] += k >> a & 1U;
      const double distance = (lattice.site(at, center) - p).norm();
      if (distance <= reach) visit(site_number<Dim>(at, center), distance);
    }
  }
}

/// All that one sender has published on one lattice, to find what is near a place.
template <int Dim>
class Published {
 public:
  Published(const ExchangeLattice<Dim>& lattice, double reach) : lattice_(lattice), reach_(reach) {}

  void add(const Leaves<Dim>& leaves);
  /// Distance to the nearest patch within the reach, nullopt if there is none [m].
  [[nodiscard]] std::optional<double> distance(const Vec<Dim>& p) const;
  [[nodiscard]] const ExchangeLattice<Dim>& lattice() const { return lattice_; }
  [[nodiscard]] double reach() const { return reach_; }

 private:
  static constexpr std::size_t kLevels = PlaneLeaf<Dim>::kHighest + 1;
  ExchangeLattice<Dim> lattice_;
  double reach_;
  CellTable<Dim> sites_;
  std::vector<std::array<CellTable<Dim>, kLevels>> tables_;  ///< Numbers of planes by their cells; as many as planes share a cell.
  std::vector<Patch<Dim>> planes_;

  void add_plane(const PlaneLeaf<Dim>& plane);
};

}  // namespace vantage
