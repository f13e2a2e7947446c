// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "vantage/geometry/box.h"

namespace vantage {

/// Soup of simplices of dimension Dim - 1: triangles in 3D, line segments in 2D. No orientation or closedness is assumed.
template <int Dim>
  requires SpatialDim<Dim>
struct Mesh {
  using Facet = std::array<std::uint32_t, Dim>;
  std::vector<Vec<Dim>> vertices;  ///< [m]
  std::vector<Facet> facets;       ///< Indices into `vertices`.

  [[nodiscard]] Box<Dim> bounds() const {
    Box<Dim> box;
    for (const Vec<Dim>& v : vertices) box.extend(v);
    return box;
  }
};

}  // namespace vantage
