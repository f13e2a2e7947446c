// SPDX-License-Identifier: Apache-2.0
// Pieces of a line, which is what a line of the plane leaves in a square.
#include <algorithm>

#include "vantage/geometry/clip.h"
#include "vantage/geometry/hausdorff.h"

namespace vantage {

template <>
double ConvexRegion<1>::measure() const {
  return count == 0 ? 0.0 : vertices[1][0] - vertices[0][0];
}

template <>
ConvexRegion<1> ConvexRegion<1>::box(const Place& low, const Place& high) {
  ConvexRegion region;
  region.vertices = {low, high};
  region.count = 2;
  return region;
}

template <>
ConvexRegion<1> ConvexRegion<1>::clipped(const Place& normal, double offset) const {
  ConvexRegion out = *this;
  if (count == 0) return out;
  if (normal[0] == 0.0) {
    if (offset < 0.0) out.count = 0;
    return out;
  }
  const double bound = offset / normal[0];
  if (normal[0] > 0.0) {
    out.vertices[1][0] = std::min(vertices[1][0], bound);
  } else {
    out.vertices[0][0] = std::max(vertices[0][0], bound);
  }
  if (out.vertices[0][0] > out.vertices[1][0]) out.count = 0;
  return out;
}

template <>
ConvexRegion<1> ConvexRegion<1>::simplified(double tolerance) const {
  ConvexRegion out = *this;
  if (measure() <= tolerance) out.count = 0;
  return out;
}

template <>
ConvexRegion<1>::Place ConvexRegion<1>::closest(const Place& p) const {
  return Place(std::clamp(p[0], vertices[0][0], vertices[1][0]));
}

template <>
ConvexRegion<1>::Place ConvexRegion<1>::edge_normal(int i) const {
  return Place(i == 0 ? -1.0 : 1.0);
}

template <>
ConvexRegion<1> outline<1>(const Feet<1>& feet) {
  const auto [low, high] = std::minmax_element(feet.at[0].begin(), feet.at[0].end());
  return ConvexRegion<1>::box(ConvexRegion<1>::Place(*low), ConvexRegion<1>::Place(*high));
}

}  // namespace vantage
