// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/field/field.h"

namespace vantage {

/// True if every squared distance within `window`, in steps of the lattice, is exact in a float.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] bool exact_in_float(const Grid<Dim>& window);

/// distance_to_set (distance.h) for windows that are exact_in_float. Axis by axis, on tiles of lines side by side (line_minimum.h). Cost: the nodes,
/// but for a small logarithm, whatever the set.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> tiled_distance(const Field<Dim, std::uint8_t>& set, double cap);

/// How far, in steps, signed_distance must look for `cap` [m] to be exact.
[[nodiscard]] double signed_reach(double spacing, double cap);

/// signed_distance (redistance.h) for caps whose signed_reach is at most kMaxLimit (line_minimum.h): both sides at once, in 16 bits. Cost: the nodes,
/// plus what the nodes closer than the cap look at.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> tiled_signed_distance(const Field<Dim, std::uint8_t>& inside, double cap);

}  // namespace vantage
