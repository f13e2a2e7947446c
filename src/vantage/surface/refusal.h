// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "vantage/surface/site_view.h"

namespace vantage {

/// Why the PCA plane of a cell did not carry its sites, so that the next plane, which is nearly the same, need not be tried: a site off the plane,
/// or two places of it too far from all sites, one in the cell and one among the sites.
template <int Dim>
struct Refusal {
  std::optional<Site<Dim>> off;
  struct Holes {
    Vec<Dim> in_cell, among;         ///< In the clipped plane and in the outline of the sites, from the cube's low corner [m].
    std::vector<Site<Dim>> extreme;  ///< Sites that span the outline: that of more sites has it inside.
  };
  std::optional<Holes> holes;

  /// Does it hold for the plane of more sites too? `limit` [m] is that of both errors. Cost follows the balls, not the sites.
  [[nodiscard]] bool holds(const Frame<Dim>& frame, const SiteView<Dim>& sites, const Cell<Dim>& cell, const Snap<Dim>& snap, double limit) const;
};

/// The sites that span the outline in the frame's plane.
template <int Dim>
[[nodiscard]] std::vector<Site<Dim>> extreme_sites(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const Snap<Dim>& snap);

}  // namespace vantage
