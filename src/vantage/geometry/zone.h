// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/geometry/box.h"

namespace vantage {

/// What lies straight above and below a polygon of the ground plane, between two heights; in 2D the polygon itself. Borders belong to it.
struct Zone {
  std::vector<std::vector<Vec<2>>> rings;     ///< The outline, then its holes; the first corner is not repeated at the end [m].
  double low = -kInfinity, high = kInfinity;  ///< Heights [m].

  template <int Dim>
    requires SpatialDim<Dim>
  [[nodiscard]] bool contains(const Vec<Dim>& p) const;
  /// Whether it has a place in common with the box.
  template <int Dim>
    requires SpatialDim<Dim>
  [[nodiscard]] bool meets(const Box<Dim>& box) const;
  [[nodiscard]] Box<2> bounds() const;
};

/// The box as a zone.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Zone box_zone(const Box<Dim>& box);

/// Takes out corners that repeat the one before them, the last one too where it repeats the first. Throws bad_input at `where` for a ring that has
/// fewer than three then, a corner that is not finite, heights the wrong way round, and rings that cross or touch themselves or each other.
void tidy_zone(Zone& zone, const std::string& where);

}  // namespace vantage
