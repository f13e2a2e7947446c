// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "vantage/surface/fit.h"

namespace vantage {

template <int Dim>
using Clusters = std::array<std::vector<Site<Dim>>, 2>;

/// Number of parts (1, 2, or 3 for more) into which the sites fall if those within `reach` of each other [m] are joined. A patch is connected, so
/// one within the limit both ways carries points of one part only, for a reach of twice the limit; two parts are written to `clusters`.
template <int Dim>
[[nodiscard]] int connected_parts(std::span<const Site<Dim>> sites, const Snap<Dim>& snap, double reach, Clusters<Dim>& clusters);

/// Splits the sites of a cell into two clusters, each near a piece of a plane of its own; `axis` of the frame gives the first cut. nullopt
/// if that leads nowhere: a cluster runs empty, or a sample of the points already lies off both pieces or shows a hole. Deterministic in the
/// multiset of sites; reads all of them only when the sample promises success.
template <int Dim>
[[nodiscard]] std::optional<Clusters<Dim>> two_clusters(GatheredSites<Dim>& sites, const Cell<Dim>& cell, const FitRules<Dim>& rules,
                                                        const Frame<Dim>& frame, int axis);

/// Is there a place on the frame's plane, between the feet of two sites of `sample` and inside the cell, with no site within `radius` [m]? Tries
/// some midpoints; any patch of that plane which spans the sample then fails for a radius of the limit. `sites` are the cell's.
template <int Dim>
[[nodiscard]] bool shows_hole(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell, const Frame<Dim>& frame,
                              const Snap<Dim>& snap, double radius);

}  // namespace vantage
