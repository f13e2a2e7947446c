// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/exchange/cloud_cells.h"
#include "vantage/exchange/published.h"

namespace vantage {

/// What a scan adds to a map, and how well both agree afterwards.
template <int Dim>
struct Novelty {
  Leaves<Dim> leaves;
  std::size_t new_points = 0;    ///< Of the scan, farther than the reach from all that was published before.
  double data_to_surface = 0.0;  ///< Upper bound over all points of the scan, to what was published before and now [m].
  double surface_to_data = 0.0;  ///< Upper bound over all places of `leaves`, to the points of the scan [m].
};

/// Planes in the largest cells in which every place of the plane has a point of the scan within the reach, as far as they serve new points; sites
/// for the others. What is chosen is added to `published`. A pure function of the set of points and of what was published.
template <int Dim>
[[nodiscard]] Novelty<Dim> select_leaves(const CloudCells<Dim>& cloud, Published<Dim>& published);

}  // namespace vantage
