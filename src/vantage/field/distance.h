// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <span>

#include "vantage/field/field.h"
#include "vantage/geometry/patch.h"

namespace vantage {

inline constexpr std::int32_t kNoSite = -1;

/// For every node the linear index of the nearest node of `set` (non-zero), ties to the smaller coordinates axis by axis; kNoSite where the set is
/// empty. Exact, separable (Felzenszwalb and Huttenlocher 2012): cost is linear in the nodes. At most 2^31 nodes.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim, std::int32_t> nearest_sites(const Field<Dim, std::uint8_t>& set);

/// Distance from every node to the nearest node of `set`, at most `cap` [m].
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> distance_to_set(const Field<Dim, std::uint8_t>& set, double cap = std::numeric_limits<float>::max());

/// Distance from every node to the nearest patch, at most `cap` [m]. Exact for nodes within half a cell diagonal of a patch, and every place on a
/// patch in the window has such a node; beyond, exact to the patch that is nearest to the nearest of them, which errs upwards by less than one
/// diagonal. Small caps cost in proportion to the nodes near the patches.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> distance_to_patches(std::span<const Patch<Dim>> patches, const Grid<Dim>& window,
                                             double cap = std::numeric_limits<float>::max());

}  // namespace vantage
