// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <span>

#include "vantage/surface/site_view.h"

namespace vantage {

/// Why no one or two patches can represent a cell's sites within a tolerance both ways, whatever else is added or how they are clustered; so
/// that an update need not read the sites again. Two kinds:
/// - General position: 2 Dim + 1 sites of which every Dim + 1 span a simplex wider than twice the tolerance. One of two planes would carry that many.
/// - Islands: three sites, and on the way from each to each other a ball of twice the tolerance without any site. A patch is convex: one that
///   carries two of them passes through the ball, farther than the tolerance from all sites.
/// Lengths are in steps of the lattice.
template <int Dim>
  requires SpatialDim<Dim>
class Proof {
 public:
  static constexpr int kGeneral = 2 * Dim + 1;
  static constexpr int kIslands = 3;

  /// Looks for one in a sample of the sites of `cell`. May miss one that exists. nullptr: none found.
  [[nodiscard]] static std::unique_ptr<Proof> find(const SiteView<Dim>& sites, const Cell<Dim>& cell, double tolerance);

  /// Does it stand when these (in Morton order) are added, or taken out?
  [[nodiscard]] bool survives_adding(std::span<const Site<Dim>> sites, const Cell<Dim>& cell) const;
  [[nodiscard]] bool survives_removing(std::span<const Site<Dim>> sites) const;

 private:
  std::array<Site<Dim>, kGeneral> sites_{};
  std::array<Vec<Dim>, kIslands> balls_;
  double radius_ = 0.0;
  int count_ = 0;  ///< kGeneral, or kIslands with as many balls.

  bool find_general(std::span<const Site<Dim>> sample, double tolerance);
  bool find_islands(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell, double tolerance);
};

/// Least distance between two parallel planes (lines) with the simplex between them.
template <int Dim>
[[nodiscard]] double width(const std::array<Vec<Dim>, Dim + 1>& simplex);

}  // namespace vantage
