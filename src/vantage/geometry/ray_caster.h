// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "vantage/geometry/mesh.h"

namespace vantage {

/// First hits of rays with a mesh: triangles in 3D, line segments in 2D. Embree walks the boxes and every facet is tested in double, so a hit does
/// not depend on Embree's version or the machine's vector width: it is the least (range, index) of all facets. Shared edges and corners do not leak;
/// a facet seen edge-on is not met. Throws bad_input for a vertex that is not finite or an index out of range.
template <int Dim>
  requires SpatialDim<Dim>
class RayCaster {
 public:
  struct Hit {
    double range = kInfinity;          ///< [m]; infinity: nothing met.
    std::uint32_t facet = 0xffffffff;  ///< Index into mesh.facets.
  };

  explicit RayCaster(const Mesh<Dim>& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// First hit of `origin + t direction`, 0 <= t <= max_range; `direction` has unit length. Thread-safe.
  [[nodiscard]] Hit cast(const Vec<Dim>& origin, const Vec<Dim>& direction, double max_range = kInfinity) const;
  /// Distance from p to the nearest facet, at most `cap` [m]. Thread-safe.
  [[nodiscard]] double distance(const Vec<Dim>& p, double cap = kInfinity) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
