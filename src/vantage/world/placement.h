// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/geometry/angle.h"
#include "vantage/geometry/vec.h"

namespace vantage {

/// Where a thing stands: the place of its own origin, and a turn in the plane of the first two axes (in 3D about the vertical).
template <int Dim>
  requires SpatialDim<Dim>
struct Placement {
  Vec<Dim> origin = Vec<Dim>::Zero();  ///< [m]
  double cosine = 1.0, sine = 0.0;     ///< Of the turn.

  /// World place of a place given in the thing's own frame [m].
  [[nodiscard]] Vec<Dim> operator()(const Vec<Dim>& local) const {
    Vec<Dim> p = local;
    p[0] = cosine * local[0] - sine * local[1];
    p[1] = sine * local[0] + cosine * local[1];
    return p + origin;
  }
  /// Placement of a thing that stands at `local` in this frame, turned by `turn` [rad] against it.
  [[nodiscard]] Placement at(const Vec<Dim>& local, double turn = 0.0) const {
    const auto [s, c] = sin_cos(turn);
    return {(*this)(local), cosine * c - sine * s, sine * c + cosine * s};
  }
};

}  // namespace vantage
