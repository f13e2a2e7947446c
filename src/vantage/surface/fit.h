// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "vantage/geometry/patch.h"
#include "vantage/surface/site_view.h"

namespace vantage {

/// What decides whether a cell's points are represented well enough.
template <int Dim>
struct FitRules {
  Snap<Dim> snap;
  double limit = 0.0;           ///< Largest error of a fit between patches and sites: eta less the slack of the snapping [m].
  std::int64_t min_points = 0;  ///< Fewest points of a fitted cell.
  bool paper = false;           ///< Planes only, clusters of at least min_points, best fit kept at the depth limit.
};

/// Patches of a leaf, with the bounds of their errors, and the numbers of the sites that none of them carries.
template <int Dim>
struct CellFit {
  std::vector<Patch<Dim>> patches;
  std::vector<std::uint32_t> loose;
};

/// One patch through `sites` as the node rule has it: the PCA plane clipped to `cell` (if given), then the flat of the rank the points have, in
/// their box along the principal axes. nullopt if no such patch is within the limit both ways.
template <int Dim>
[[nodiscard]] std::optional<Patch<Dim>> fit_flat(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules,
                                                 const Cell<Dim>* cell);

/// Steps 2 and 3 of the node rule, for at least rules.min_points sites and their moments: one patch, or two for two clusters; nullopt: split the
/// cell. A pure function of the multiset of sites. Large cells that fail mostly do so without all their sites being read.
template <int Dim>
[[nodiscard]] std::optional<CellFit<Dim>> fit_cell(GatheredSites<Dim>& sites, const Moments<Dim>& moments, const Cell<Dim>& cell,
                                                   const FitRules<Dim>& rules);

/// Step 4 at the depth limit: the flat through the sites for those it carries within the limit; the others are loose. In paper mode the best
/// fit, whatever its error.
template <int Dim>
[[nodiscard]] CellFit<Dim> fit_at_limit(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules);

/// Patch of a site that stands for itself.
template <int Dim>
[[nodiscard]] Patch<Dim> loose_patch(const Site<Dim>& site, const FitRules<Dim>& rules);

}  // namespace vantage
