// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/visibility/depth_image.h"
#include "vantage/visibility/seen_set.h"

namespace vantage {

/// Where a depth image was taken and how far it reaches.
template <int Dim>
struct Viewpoint {
  Vec<Dim> origin = Vec<Dim>::Zero();  ///< [m]
  double max_range = kInfinity;        ///< [m]
};

/// Whether the place at `offset` from the viewpoint is in range and not behind the image; the viewpoint itself always is seen.
/// The definition, and the reference for seen_from().
template <int Dim>
[[nodiscard]] bool sees(const DepthImage<Dim>& image, double max_range, const Vec<Dim>& offset) {
  double square = offset[Dim - 1] * offset[Dim - 1];
  for (int a = Dim - 2; a >= 0; --a) square = offset[a] * offset[a] + square;
  if (square > max_range * max_range || square == 0.0) return square == 0.0;
  const auto depth = static_cast<double>(image[image.pixel(offset)]);
  return square <= depth * depth;
}

/// The nodes of `window` that are seen: exactly those that sees() says, found by whole blocks. A least-and-greatest pyramid of the image decides
/// blocks of nodes at once, and only those that the boundary crosses are opened: cost follows the boundary, not the volume. Same bits for any
/// number of threads.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] SeenSet<Dim> seen_from(const DepthImage<Dim>& image, const Viewpoint<Dim>& viewpoint, const Grid<Dim>& window);

}  // namespace vantage
