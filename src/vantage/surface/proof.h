// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <span>

#include "vantage/surface/site_view.h"

namespace vantage {

/// Why so many patches (one; in paper mode two) cannot represent a cell's sites within a tolerance both ways, whatever else is added or how they
/// are clustered; so that an update need not read the sites again. Two kinds:
/// - General position: Dim patches + 1 sites of which every Dim + 1 span a simplex wider than twice the tolerance. A plane carries Dim of them.
/// - Islands: one site more than patches, and on the way from each to each other a ball of twice the tolerance without any site. A patch is convex:
///   one that carries two of them passes through the ball, farther than the tolerance from all sites.
/// Lengths are in steps of the lattice.
template <int Dim>
  requires SpatialDim<Dim>
class Proof {
 public:
  struct Question {
    double data, surface;  ///< Tolerances of data to surface, and of surface to data.
    int patches = 1;       ///< Or 2.
  };
  /// Looks for one in a sample of the sites of `cell`. May miss one that exists. nullptr: none found.
  [[nodiscard]] static std::unique_ptr<Proof> find(const SiteView<Dim>& sites, const Cell<Dim>& cell, const Question& question);

  /// Does it stand when these (in Morton order) are added, or taken out?
  [[nodiscard]] bool survives_adding(std::span<const Site<Dim>> sites, const Cell<Dim>& cell) const;
  [[nodiscard]] bool survives_removing(std::span<const Site<Dim>> sites) const;

 private:
  std::array<Site<Dim>, 2 * Dim + 1> sites_{};
  std::array<Vec<Dim>, 3> balls_;
  double radius_ = 0.0;
  int count_ = 0, ball_count_ = 0;

  bool find_general(std::span<const Site<Dim>> sample, double tolerance, int patches);
  bool find_two_islands(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell);
  bool find_three_islands(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell);
};

/// Least distance between two parallel planes (lines) with the simplex between them.
template <int Dim>
[[nodiscard]] double width(const std::array<Vec<Dim>, Dim + 1>& simplex);

}  // namespace vantage
