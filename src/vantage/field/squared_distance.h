// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/field/field.h"

namespace vantage {

/// Squared distance from every node to the nearest node of `set` (non-zero) in steps of the lattice; kFarSquare (line_minimum.h) if the set is empty.
/// Exact while the squared diagonal of the window is below kExactSquare. Cost: linear in the nodes but for a small logarithm, any set.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> squared_distances(const Field<Dim, std::uint8_t>& set);

/// Squared distance to the nearest node of the other side, > 0 where `inside` is non-zero, < 0 elsewhere, in steps of the lattice; exact where it is at
/// most limit^2 and beyond that elsewhere. `limit`: at most kMaxLimit (line_minimum.h). Cost follows the share of nodes near the boundary.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim, std::int16_t> signed_squares(const Field<Dim, std::uint8_t>& inside, int limit);

}  // namespace vantage
