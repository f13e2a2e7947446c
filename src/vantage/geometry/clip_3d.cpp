// SPDX-License-Identifier: Apache-2.0
// Convex polygons, counter-clockwise, which is what a plane of space leaves in a cube.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "vantage/geometry/clip.h"
#include "vantage/geometry/hausdorff.h"

namespace vantage {
namespace {

using Place = ConvexRegion<2>::Place;

double cross(const Place& a, const Place& b) { return a[0] * b[1] - a[1] * b[0]; }

Place closest_on_edge(const Place& a, const Place& b, const Place& p) {
  const Place ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0.0 ? Place(a + std::clamp(ab.dot(p - a) / length2, 0.0, 1.0) * ab) : a;
}

}  // namespace

template <>
ConvexRegion<2> ConvexRegion<2>::box(const Place& low, const Place& high) {
  ConvexRegion region;
  region.vertices[0] = low;
  region.vertices[1] = {high[0], low[1]};
  region.vertices[2] = high;
  region.vertices[3] = {low[0], high[1]};
  region.count = 4;
  return region;
}

template <>
ConvexRegion<2> ConvexRegion<2>::clipped(const Place& normal, double offset) const {  // Sutherland and Hodgman 1974.
  ConvexRegion out;
  for (int i = 0; i < count; ++i) {
    const Place &a = vertices[i], &b = vertices[(i + 1) % count];
    const double outside_a = normal.dot(a) - offset, outside_b = normal.dot(b) - offset;
    assert(out.count + 2 <= kMaxVertices);
    if (outside_a <= 0.0) out.vertices[out.count++] = a;
    if ((outside_a < 0.0 && outside_b > 0.0) || (outside_a > 0.0 && outside_b < 0.0))
      out.vertices[out.count++] = a + outside_a / (outside_a - outside_b) * (b - a);
  }
  return out;
}

template <>
ConvexRegion<2> ConvexRegion<2>::simplified(double tolerance) const {
  ConvexRegion out;
  for (int i = 0; i < count; ++i)
    if (out.count == 0 || (vertices[i] - out.vertices[out.count - 1]).norm() > tolerance) out.vertices[out.count++] = vertices[i];
  while (out.count > 1 && (out.vertices[out.count - 1] - out.vertices[0]).norm() <= tolerance) --out.count;
  if (out.count < 3) out.count = 0;
  return out;
}

template <>
Place ConvexRegion<2>::edge_normal(int i) const {
  const Place edge = vertices[(i + 1) % count] - vertices[i];
  const double length2 = edge.squaredNorm();
  double size2 = 0.0;
  for (int k = 1; k < count; ++k) size2 = std::max(size2, (vertices[k] - vertices[0]).squaredNorm());
  if (!(length2 > kLeastEdge * kLeastEdge * size2)) return Place::Zero();
  const double length = std::sqrt(length2);
  return {edge[1] / length, -edge[0] / length};
}

template <>
Place ConvexRegion<2>::closest(const Place& p) const {
  bool inside = true;
  Place best = vertices[0];
  double best2 = kInfinity;
  for (int i = 0; i < count; ++i) {
    const Place &a = vertices[i], &b = vertices[(i + 1) % count];
    if (cross(b - a, p - a) >= 0.0 || !(edge_normal(i).squaredNorm() > 0.0)) continue;
    inside = false;
    const Place q = closest_on_edge(a, b, p);
    if ((q - p).squaredNorm() < best2) {
      best2 = (q - p).squaredNorm();
      best = q;
    }
  }
  return inside ? p : best;
}

template <>
double ConvexRegion<2>::measure() const {
  double twice = 0.0;
  for (int i = 1; i + 1 < count; ++i) twice += cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  return 0.5 * twice;
}

template <>
ConvexRegion<2> outline<2>(const Feet<2>& feet) {
  Place low = Place::Constant(kInfinity), high = -low, low_diagonal = low, high_diagonal = high;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const Place p(feet.at[0][i], feet.at[1][i]), diagonal(p[0] + p[1], p[0] - p[1]);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    low_diagonal = low_diagonal.cwiseMin(diagonal);
    high_diagonal = high_diagonal.cwiseMax(diagonal);
  }
  const Place sum(1.0, 1.0), difference(1.0, -1.0);
  return ConvexRegion<2>::box(low, high)
      .clipped(sum, high_diagonal[0])
      .clipped(-sum, -low_diagonal[0])
      .clipped(difference, high_diagonal[1])
      .clipped(-difference, -low_diagonal[1]);
}

}  // namespace vantage
