// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "vantage/geometry/patch.h"
#include "vantage/surface/cell_fit.h"
#include "vantage/surface/refusal.h"
#include "vantage/surface/site_view.h"
#include "vantage/surface/spacing.h"

namespace vantage {

/// What decides whether a cell's points are represented well enough.
template <int Dim>
struct FitRules {
  Snap<Dim> snap;
  double limit = 0.0;           ///< Largest error of a fit between patches and sites: eta less the slack of the snapping [m].
  std::int64_t min_points = 0;  ///< Fewest points of a fitted cell.
  bool paper = false;           ///< Planes only, clusters of at least min_points, best fit kept at the depth limit.
  bool sharp = false;           ///< Bounds of errors are at most 10 % above the truth; else any within the limit.
  /// If given, places of a patch may be farther than the limit from the sites: as far as these are apart.
  const SensorSpacing<Dim>* spacing = nullptr;
};

/// Points with an extent below this share of the limit have none in that axis.
inline constexpr double kThin = 0.5;

/// What a fit of the full rank was like.
template <int Dim>
struct FlatReport {
  double data = 0.0, surface = 0.0;  ///< Errors of the clipped plane, if that is the patch [m].
  Refusal<Dim> refusal;              ///< If there is none.
};

/// One patch through `sites`: the PCA plane clipped to `cell` (if given), then the flat of the rank the points have, in their outline along the
/// principal axes (`paper`: in their bounding box). nullopt if no such patch is within the limit both ways, or if its rank
/// would be above `most_rank`. `report`, if given, tells what the next update can do without the sites.
template <int Dim>
[[nodiscard]] std::optional<Patch<Dim>> fit_flat(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules,
                                                 const Cell<Dim>* cell, int most_rank, FlatReport<Dim>* report = nullptr);

/// The segment between the first and the last of the sites along the axis in which they are longest, if no site is farther than `thin` [m] from it
/// and the errors are within the limit: what a few sites in a row get, without their principal axes.
template <int Dim>
[[nodiscard]] std::optional<Patch<Dim>> fit_chord(std::span<const Site<Dim>> sites, const FitRules<Dim>& rules, double thin);

/// The patch of more sites, told by the one of the others and by what is new: how far the plane moves bounds how much the errors grow. nullopt: not
/// this way; all sites must be asked.
template <int Dim>
[[nodiscard]] std::optional<std::pair<Patch<Dim>, Standing<Dim>>> advance(const Patch<Dim>& patch, const Standing<Dim>& standing,
                                                                          std::span<const Site<Dim>> added, const Cell<Dim>& cell,
                                                                          const FitRules<Dim>& rules);
/// Its bounds are those of the limit, whatever they could be.
template <int Dim>
void set_limit_bounds(Patch<Dim>& patch, const FitRules<Dim>& rules);

/// The plane of the frame in the bounding box of the sites, whatever its errors.
template <int Dim>
[[nodiscard]] Patch<Dim> force_plane(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const FitRules<Dim>& rules);

/// The segment between two sites.
template <int Dim>
[[nodiscard]] Patch<Dim> pair_patch(const Site<Dim>& a, const Site<Dim>& b, const Snap<Dim>& snap);

/// Patch of a site that stands for itself.
template <int Dim>
[[nodiscard]] Patch<Dim> loose_patch(const Site<Dim>& site, const FitRules<Dim>& rules);

}  // namespace vantage
