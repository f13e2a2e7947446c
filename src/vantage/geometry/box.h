// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

#include "vantage/geometry/vec.h"

namespace vantage {

/// Axis-aligned box [m]; empty when low > high in some axis.
template <int Dim>
  requires SpatialDim<Dim>
struct Box {
  Vec<Dim> low = Vec<Dim>::Constant(kInfinity);
  Vec<Dim> high = Vec<Dim>::Constant(-kInfinity);

  [[nodiscard]] bool empty() const { return (low.array() > high.array()).any(); }
  [[nodiscard]] Vec<Dim> size() const { return high - low; }
  [[nodiscard]] Vec<Dim> center() const { return 0.5 * (low + high); }
  [[nodiscard]] bool contains(const Vec<Dim>& p) const { return (p.array() >= low.array()).all() && (p.array() <= high.array()).all(); }
  [[nodiscard]] Box grown(double margin) const { return {low.array() - margin, high.array() + margin}; }
  [[nodiscard]] Box intersection(const Box& other) const { return {low.cwiseMax(other.low), high.cwiseMin(other.high)}; }
  /// Distance of p to the box; 0 inside [m].
  [[nodiscard]] double distance(const Vec<Dim>& p) const { return (low - p).cwiseMax(p - high).cwiseMax(0.0).norm(); }
  void extend(const Vec<Dim>& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void extend(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

}  // namespace vantage
