// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "vantage/field/field.h"

namespace vantage {

/// Signed distance to the boundary between `inside` (non-zero: positive) and the rest, from the nodes alone: distance to the nearest node of the
/// other side less h/2, at most `cap` [m]. Good to sqrt(Dim) h/2. Where the other side is empty: +-cap.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> signed_distance(const Field<Dim, std::uint8_t>& inside, double cap);

/// Signed distance to the zero level of `phi` (positive where phi > 0), the set kept: interface nodes by linear interpolation, the rest by fast
/// marching [m]. First order. For a real level set; the belief's bits want signed_distance. The paper's "Redistance psi" (Sec. III-A).
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> redistance(const Field<Dim>& phi);

}  // namespace vantage
