// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// Some nodes of a window and a value each.
struct NarrowBand {
  std::vector<std::uint32_t> nodes;  ///< Linear indices; rows of nodes in order, but not the nodes of a row.
  std::vector<float> distances;      ///< [m]
};

/// signed_distance (redistance.h), to the bit, of the nodes where it is less than `reach` [m] either way; `reach` at most 16 steps, at most 2^32
/// nodes. Bits, 64 nodes at a time: one look at every node, then reach^Dim steps for each word that the band meets.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] NarrowBand narrow_band(const Field<Dim, std::uint8_t>& inside, double reach);

}  // namespace vantage
