// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>

#include "vantage/geometry/clip.h"
#include "vantage/geometry/patch.h"

namespace vantage {

/// A patch relative to the viewpoint, with what a ray test needs worked out once.
template <int Dim>
struct Occluder {
  Patch<Dim> patch;
  Vec<Dim> center, n;
  double height = 0.0, radius = 0.0;
  std::array<Vec<Dim>, Patch<Dim>::kMaxVertices> edge_normal;
  std::array<double, Patch<Dim>::kMaxVertices> edge_offset;

  Occluder(const Patch<Dim>& source, const Vec<Dim>& origin) : patch(source), center(Vec<Dim>::Zero()), n(Vec<Dim>::Zero()) {
    for (int i = 0; i < patch.count; ++i) center += (patch.vertices[i] -= origin) / patch.count;
    for (const Vec<Dim>& v : patch.corners()) radius = std::max(radius, (v - center).norm());
    if (patch.count < 3) return;
    n = normal(patch);
    height = n.dot(patch.vertices[0]);
    for (int i = 0; i < patch.count; ++i) {
      const Vec<Dim>& a = patch.vertices[i];
      const Vec<Dim> along = patch.vertices[(i + 1) % patch.count] - a, inward = center - a;
      Vec<Dim> outward = along * (along.dot(inward) / std::max(along.squaredNorm(), 1e-300)) - inward;
      outward -= n * n.dot(outward);
      const double length = along.norm() > kLeastEdge * radius ? outward.norm() : 0.0;  // Between corners that are one, an edge runs anywhere.
      edge_normal[static_cast<std::size_t>(i)] = length > 0.0 ? Vec<Dim>(outward / length) : Vec<Dim>(Vec<Dim>::Zero());
      edge_offset[static_cast<std::size_t>(i)] = edge_normal[static_cast<std::size_t>(i)].dot(a);
    }
  }

  /// Range where `direction` meets the patch widened by `margin`; infinity if it does not. Corners are mitred, at most out to `margin` from
  /// the patch's circumscribed ball.
  [[nodiscard]] double range(const Vec<Dim>& direction, double margin) const {
    if (patch.count < 3) return ray_range<Dim>(patch, Vec<Dim>::Zero(), direction, margin).value_or(kInfinity);
    const double slope = n.dot(direction);
    if (slope == 0.0) return kInfinity;
    const double t = height / slope;
    if (!(t >= 0.0)) return kInfinity;
    const Vec<Dim> q = t * direction;
    if ((q - center).norm() > radius + margin) return kInfinity;
    for (int i = 0; i < patch.count; ++i)
      if (edge_normal[static_cast<std::size_t>(i)].dot(q) - edge_offset[static_cast<std::size_t>(i)] > margin) return kInfinity;
    return t;
  }
};

}  // namespace vantage
