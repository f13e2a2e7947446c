// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/exchange/leaves.h"

namespace vantage {

template <int Dim>
struct Cover {
  std::vector<SiteLeaf<Dim>> leaves;  ///< In the order of Leaves.
  double farthest = 0.0;              ///< Largest distance of a site to its nearest point [m].
};

/// Sites such that every point has one within `reach` (that of the lattice), and every site a point: greedily those that serve most points first
/// (Johnson 1974), then without what the others serve. A pure function of the points in the order of CloudCells.
template <int Dim>
[[nodiscard]] Cover<Dim> cover(const ExchangeLattice<Dim>& lattice, std::span<const Vec<Dim>> points, double reach);

}  // namespace vantage
