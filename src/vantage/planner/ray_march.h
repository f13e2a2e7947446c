// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/march_grid.h"

namespace vantage {

/// `count` unit directions spread evenly over the circle or sphere (Fibonacci lattice), turned at random by the seed, (count, Dim).
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> spread_directions(std::size_t count, std::uint64_t seed);
template <>
std::vector<Vec<2>> spread_directions<2>(std::size_t count, std::uint64_t seed);
template <>
std::vector<Vec<3>> spread_directions<3>(std::size_t count, std::uint64_t seed);

/// How many directions a number of rays for 3D stands for: in 2D a quarter does (planner.md Sec. 3); 16 at least.
template <int Dim>
[[nodiscard]] constexpr std::size_t rays_in(std::int64_t rays) {
  const std::int64_t fewer = rays >> (2 * (3 - Dim));
  return static_cast<std::size_t>(fewer > 16 ? fewer : 16);
}

/// What the rays from one place add up to, before the terms are mixed.
struct RaySums {
  double volume = 0.0;       ///< Expected new volume: sum of w T r^(d-1) dt dOmega [m^Dim].
  double solid_angle = 0.0;  ///< Of the shadow boundary in view: sum of w dOmega [sr or rad].
  double area = 0.0;         ///< Eq. (1) with line of sight: sum of w tau r^(d-1) dOmega [m^(Dim-1)].

  [[nodiscard]] RaySums scaled(double by) const { return {by * volume, by * solid_angle, by * area}; }
};

/// Rays through the belief, from cell to cell; a node's cell is the cube around it. They end at the first cell that is not seen.
template <int Dim>
  requires SpatialDim<Dim>
class RayMarch {
 public:
  struct Medium {
    double lambda = 0.0;                   ///< Opacity of the unseen [1/m].
    double max_range = 80.0;               ///< [m]
    double tau_power = 0.0;                ///< tau = r^-p.
    const Field<Dim>* weight = nullptr;    ///< w per node [1]; none: 1 everywhere.
    const MarchGrid<Dim>* grid = nullptr;  ///< Of the same states, to stride over what is alike; none: cell by cell, with the same result.
  };
  /// `openness`: for each unseen node the probability that it opens when looked at, 0 where nothing is known [1]. All must outlive this.
  RayMarch(const BeliefView<Dim>& view, const Field<Dim>& openness, const Medium& medium);

  /// Ray form of the metric (method.md Sec. 5) over `directions`, which share the full sphere evenly.
  [[nodiscard]] RaySums look(const Vec<Dim>& origin, std::span<const Vec<Dim>> directions) const;

  /// Volume of the unseen that the rays pass through up to the first known surface: what a scan here shows at most [m^Dim]. The samples stand at
  /// fixed places, so it never rises while nodes only turn from unseen to seen and from either to obstacle. `openness`, lambda and tau do not count.
  [[nodiscard]] double unseen_volume(const Vec<Dim>& origin, std::span<const Vec<Dim>> directions) const;

  /// True if the straight line from `from` runs through seen cells until it is within `slack` of `to` [m].
  [[nodiscard]] bool line_of_sight(const Vec<Dim>& from, const Vec<Dim>& to, double slack) const;
  /// Of the `directions` of each sector (sector_of) along which known surface is met first, the largest last component: the sine of the highest
  /// elevation with a hit; -1: none. (sectors)
  [[nodiscard]] std::vector<double> highest_hits(const Vec<Dim>& origin, std::span<const Vec<Dim>> directions, std::size_t sectors) const;
  /// w at a place; 1 outside of the window.
  [[nodiscard]] double weight_at(const Vec<Dim>& place) const;
  [[nodiscard]] double spacing() const { return view_.window().spacing; }

 private:
  BeliefView<Dim> view_;
  const Field<Dim>& openness_;
  Medium medium_;
  std::vector<std::array<double, Dim + 1>> fading_;  // Of n cells of the unseen: sums of f^k k^j for k < n, j < Dim, and f^n; f: left after a cell.
};

/// x^-power, with the power rounded down to quarters (+ - * / sqrt only).
[[nodiscard]] double inverse_power(double x, double power);

/// Share of the seen space's walls per volume as a mean free path of the place itself: A / (4 V) in 3D, A / (pi V) in 2D [1/m], with A the known
/// surface, from its lattice faces, and V the seen volume. 0 while nothing is known.
template <int Dim>
[[nodiscard]] double measured_opacity(const BeliefView<Dim>& view);

/// Which of so many sectors of azimuth a direction lies in; of a plane: its left or right half.
template <int Dim>
[[nodiscard]] std::size_t sector_of(const Vec<Dim>& direction, std::size_t sectors);

}  // namespace vantage
