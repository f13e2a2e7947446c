// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "vantage/geometry/box.h"

namespace vantage {

/// A piece of reconstructed surface: a point (1 vertex), a segment (2), or in 3D a planar convex polygon (3 to 8, in order).
template <int Dim>
  requires SpatialDim<Dim>
struct Patch {
  static constexpr int kMaxVertices = 2 + 6 * (Dim - 2);

  std::array<Vec<Dim>, kMaxVertices> vertices;  ///< [m]; only the first `count` mean anything.
  std::int32_t count = 0;
  float data_to_surface = 0.0F;  ///< Certified: no point of the patch's data is farther from it [m].
  float surface_to_data = 0.0F;  ///< Certified: no place of the patch is farther from its data [m].

  [[nodiscard]] std::span<const Vec<Dim>> corners() const { return {vertices.data(), static_cast<std::size_t>(count)}; }
  [[nodiscard]] Box<Dim> bounds() const {
    Box<Dim> box;
    for (const Vec<Dim>& v : corners()) box.extend(v);
    return box;
  }
  /// 0 point, 1 segment, 2 polygon.
  [[nodiscard]] int rank() const { return count >= 3 ? 2 : count - 1; }
};

template <int Dim>
[[nodiscard]] Patch<Dim> point_patch(const Vec<Dim>& p);
template <int Dim>
[[nodiscard]] Patch<Dim> segment_patch(const Vec<Dim>& a, const Vec<Dim>& b);

/// Length in 2D, area in 3D; 0 for a point, and in 3D for a segment [m^(Dim-1)].
template <int Dim>
[[nodiscard]] double measure(const Patch<Dim>& patch);

/// Unit normal; any unit vector perpendicular to a segment, and the first axis for a point.
template <int Dim>
[[nodiscard]] Vec<Dim> normal(const Patch<Dim>& patch);

/// Place of the patch nearest to p [m].
template <int Dim>
[[nodiscard]] Vec<Dim> closest_point(const Patch<Dim>& patch, const Vec<Dim>& p);

template <int Dim>
[[nodiscard]] double distance(const Patch<Dim>& patch, const Vec<Dim>& p) {
  return (closest_point(patch, p) - p).norm();
}

/// Least distance between the patch and the segment from a to b [m]; 0 if they meet.
template <int Dim>
[[nodiscard]] double distance_to_segment(const Patch<Dim>& patch, const Vec<Dim>& a, const Vec<Dim>& b);

/// Range along the ray `origin + t direction` (unit direction, t >= 0) where it meets the patch widened by `margin` [m]: a polygon is grown in
/// its own plane, a segment or point (in 2D: the ends of a segment) becomes a ball of that radius swept along it. nullopt: no meeting.
template <int Dim>
[[nodiscard]] std::optional<double> ray_range(const Patch<Dim>& patch, const Vec<Dim>& origin, const Vec<Dim>& direction, double margin);

}  // namespace vantage
