// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>

#include "vantage/geometry/box.h"

namespace vantage {

/// A window of one global lattice whose node i stands at `spacing * i`: all windows of equal spacing share their nodes.
template <int Dim>
  requires SpatialDim<Dim>
struct Grid {
  double spacing = 1.0;                    ///< h [m]
  Index<Dim> first = Index<Dim>::Zero();   ///< Global lattice index of the first node.
  Index<Dim> extent = Index<Dim>::Zero();  ///< Nodes along each axis.

  [[nodiscard]] std::size_t size() const {
    std::size_t n = 1;
    for (int a = 0; a < Dim; ++a) n *= static_cast<std::size_t>(extent[a]);
    return n;
  }
  /// Step in the linear index along an axis; axis 0 is contiguous.
  [[nodiscard]] std::size_t stride(int axis) const {
    std::size_t s = 1;
    for (int a = 0; a < axis; ++a) s *= static_cast<std::size_t>(extent[a]);
    return s;
  }
  /// `local` counts from `first`.
  [[nodiscard]] bool inside(const Index<Dim>& local) const { return (local.array() >= 0).all() && (local.array() < extent.array()).all(); }
  [[nodiscard]] std::size_t linear(const Index<Dim>& local) const {
    std::size_t i = 0;
    for (int a = Dim - 1; a >= 0; --a) i = i * static_cast<std::size_t>(extent[a]) + static_cast<std::size_t>(local[a]);
    return i;
  }
  [[nodiscard]] Index<Dim> local(std::size_t linear_index) const {
    Index<Dim> i;
    for (int a = 0; a < Dim; ++a) {
      i[a] = static_cast<std::int32_t>(linear_index % static_cast<std::size_t>(extent[a]));
      linear_index /= static_cast<std::size_t>(extent[a]);
    }
    return i;
  }
  [[nodiscard]] Vec<Dim> position(const Index<Dim>& local_index) const { return (first + local_index).template cast<double>() * spacing; }
  [[nodiscard]] Vec<Dim> position(std::size_t linear_index) const { return position(local(linear_index)); }
  /// Node nearest to p, counted from `first`; may lie outside.
  [[nodiscard]] Index<Dim> nearest(const Vec<Dim>& p) const {
    Index<Dim> i;
    for (int a = 0; a < Dim; ++a) i[a] = static_cast<std::int32_t>(std::floor(p[a] / spacing + 0.5)) - first[a];
    return i;
  }
  [[nodiscard]] Box<Dim> bounds() const {
    const Index<Dim> last = extent.array() - 1;
    return {position(Index<Dim>::Zero()), position(last)};
  }
  [[nodiscard]] bool operator==(const Grid&) const = default;
};

/// Smallest window whose nodes cover `box`; throws bad_input for an empty box.
template <int Dim>
[[nodiscard]] Grid<Dim> window_over(const Box<Dim>& box, double spacing);

/// Nodes that both windows hold; their spacings are equal.
template <int Dim>
[[nodiscard]] Grid<Dim> intersection(const Grid<Dim>& a, const Grid<Dim>& b);

/// `window` grown by `nodes` on every side.
template <int Dim>
[[nodiscard]] Grid<Dim> padded(const Grid<Dim>& window, int nodes);

}  // namespace vantage
