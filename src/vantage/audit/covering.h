// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "vantage/audit/box_tree.h"
#include "vantage/geometry/patch.h"

namespace vantage {

/// Distances between one patch and points, by definitions of their own: the check of a certificate must not share the code that made it.
template <int Dim>
  requires SpatialDim<Dim>
class FlatPiece {
 public:
  explicit FlatPiece(const Patch<Dim>& patch);
  /// Squared distance from p [m^2]: to the plane if p is above the polygon, else to the nearest edge.
  [[nodiscard]] double distance2(const Patch<Dim>& patch, const Vec<Dim>& p) const;

 private:
  [[nodiscard]] Vec<2> in_plane(const Vec<Dim>& v) const { return {u_.dot(v), w_.dot(v)}; }
  [[nodiscard]] bool is_inside(const Patch<Dim>& patch, const Vec<2>& foot) const;

  Vec<Dim> u_, w_;       ///< Orthonormal, in the polygon's plane.
  bool inside_ = false;  ///< There is an inside: not a point, a segment or a sliver.
};

/// Bounds of the largest distance from a place of a patch to the nearest point [m].
struct Covering {
  double low = 0.0, high = 0.0;
};

/// `tree` is over `points`. `high` is at most 0.1 % above `low` (or within rounding of it); both are infinite without points. The patch is halved
/// across its longest edge as long as that is not so: no place of a piece is farther from the points than the piece's farthest corner from one of
/// them.
template <int Dim>
[[nodiscard]] Covering covering_of(const Patch<Dim>& patch, std::span<const Vec<Dim>> points, const BoxTree<Dim>& tree);

}  // namespace vantage
