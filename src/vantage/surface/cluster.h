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

/// Sites by the parts into which they fall if those within some reach of each other are joined.
struct Parts {
  std::vector<std::uint32_t> order;   ///< Numbers of the sites, part by part, rising within one.
  std::vector<std::uint32_t> starts;  ///< Where each part begins in `order`, and where the last one ends.

  [[nodiscard]] std::size_t size() const { return starts.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t part) const {
    return std::span(order).subspan(starts[part], starts[part + 1] - starts[part]);
  }
};

/// A patch is connected: one within the limit both ways carries sites of one part only, for a `reach` [m] of twice the limit. Quadratic time.
template <int Dim>
void find_parts(std::span<const Site<Dim>> sites, const Snap<Dim>& snap, double reach, Parts& parts);

/// Splits the sites of a cell into two clusters, each near a piece of a plane of its own; `axis` of the frame gives the first cut. nullopt
/// if that leads nowhere: a cluster runs empty, or a sample of the points already lies off both pieces or shows a hole. Deterministic in the
/// multiset of sites; reads all of them only when the sample promises success.
template <int Dim>
[[nodiscard]] std::optional<Clusters<Dim>> two_clusters(GatheredSites<Dim>& sites, const Cell<Dim>& cell, const FitRules<Dim>& rules,
                                                        const Frame<Dim>& frame, int axis);

/// Is the foot of some pair's midpoint on the frame's plane inside the cell and without a site within `radius` [m]? Any patch of that plane that
/// spans the pairs then fails for a limit of `radius`. `sites` are the cell's.
template <int Dim>
[[nodiscard]] bool shows_hole(std::span<const std::array<Site<Dim>, 2>> pairs, const SiteView<Dim>& sites, const Cell<Dim>& cell,
                              const Frame<Dim>& frame, const Snap<Dim>& snap, double radius);

}  // namespace vantage
