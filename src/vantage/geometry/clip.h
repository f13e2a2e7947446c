// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "vantage/geometry/box.h"
#include "vantage/geometry/plane_fit.h"

namespace vantage {

/// Shorter edges, as a share of the size of what they bound, are none.
inline constexpr double kLeastEdge = 1e-9;

/// Convex piece of a line (Rank 1: an interval) or of a plane (Rank 2: a polygon in order), in coordinates within it [m].
template <int Rank>
  requires(Rank == 1 || Rank == 2)
struct ConvexRegion {
  using Place = Eigen::Matrix<double, Rank, 1>;
  static constexpr int kMaxVertices = 2 + 10 * (Rank - 1);

  std::array<Place, kMaxVertices> vertices;
  int count = 0;  ///< 0: empty.

  /// The box between `low` and `high`.
  [[nodiscard]] static ConvexRegion box(const Place& low, const Place& high);
  /// What lies in the half-space `normal . x <= offset`.
  [[nodiscard]] ConvexRegion clipped(const Place& normal, double offset) const;
  /// Without corners nearer than `tolerance` to their neighbours; empty if too few remain.
  [[nodiscard]] ConvexRegion simplified(double tolerance) const;
  /// Nearest place of the region.
  [[nodiscard]] Place closest(const Place& p) const;
  /// Unit normal, outwards, of the edge from vertex i to the next (Rank 1: of vertex i); zero if the edge is shorter than kLeastEdge of the region's
  /// size: between corners that rounding alone keeps apart an edge runs anywhere, across the region too.
  [[nodiscard]] Place edge_normal(int i) const;
  /// Length or area.
  [[nodiscard]] double measure() const;
};

/// Half-spaces of a region, to tell inside from outside fast.
template <int Rank>
class RegionEdges {
 public:
  using Place = typename ConvexRegion<Rank>::Place;
  explicit RegionEdges(const ConvexRegion<Rank>& region) {
    for (int i = 0; i < region.count; ++i)
      if (const Place n = region.edge_normal(i); n.squaredNorm() > 0.0) {
        normals_[count_] = n;
        offsets_[count_++] = n.dot(region.vertices[i]);
      }
  }
  /// Largest signed distance to an edge: at most that to the region, negative inside.
  [[nodiscard]] double outside(const Place& p) const {
    double most = -kInfinity;
    for (int i = 0; i < count_; ++i) most = std::max(most, normals_[i].dot(p) - offsets_[i]);
    return most;
  }

 private:
  std::array<Place, ConvexRegion<Rank>::kMaxVertices> normals_;
  std::array<double, ConvexRegion<Rank>::kMaxVertices> offsets_;
  int count_ = 0;
};

/// Where the hyperplane through the frame's origin spanned by its first Dim - 1 axes meets `box`, in coordinates along those axes;
/// empty if they do not meet in a piece of measure above rounding.
template <int Dim>
[[nodiscard]] ConvexRegion<Dim - 1> clip_to_box(const Frame<Dim>& frame, const Box<Dim>& box);

}  // namespace vantage
