// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "vantage/geometry/vec.h"

namespace vantage {

/// Point on an integer lattice, and last a tag: a number that means something to who made it.
template <int Dim>
using Site = std::array<std::uint32_t, Dim + 1>;

/// Wide enough for sums of squares of 2^31 sites, so that moments do not depend on the order of the points.
__extension__ using WideInt = __int128;

/// Exact sums over sites.
template <int Dim>
  requires SpatialDim<Dim>
struct Moments {
  static constexpr int kProducts = Dim * (Dim + 1) / 2;
  std::int64_t count = 0;
  std::array<WideInt, Dim> sum{};
  std::array<WideInt, kProducts> product{};  ///< xx, xy, (xz,) yy, (yz, zz).

  void add(const Moments& other);
};

/// Moments of `sites`, which lie in [base, base + 2^bits) in each axis: the smaller, the faster. Exact for fewer than 2^31 sites.
template <int Dim>
[[nodiscard]] Moments<Dim> moments(std::span<const Site<Dim>> sites, const Site<Dim>& base, int bits);

/// Mean and principal axes.
template <int Dim>
  requires SpatialDim<Dim>
struct Frame {
  Vec<Dim> origin;                       ///< [m]
  Eigen::Matrix<double, Dim, Dim> axes;  ///< Orthonormal columns, by falling variance: the last one is the normal of the PCA plane.
  Vec<Dim> variance;                     ///< Along the axes [m^2].

  /// Coordinates of p along the axes [m].
  [[nodiscard]] Vec<Dim> local(const Vec<Dim>& p) const { return axes.transpose() * (p - origin); }
};

/// Principal component analysis of sites with `moments` (count > 0); a site x lies at `step * x` [m]. A pure function of the multiset of sites.
template <int Dim>
[[nodiscard]] Frame<Dim> principal_frame(const Moments<Dim>& moments, double step);

}  // namespace vantage
