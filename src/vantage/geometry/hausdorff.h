// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "vantage/geometry/clip.h"

namespace vantage {

/// Points seen from a line (Rank 1) or plane (Rank 2): where their feet stand in it, and how far away they are.
template <int Rank>
struct Feet {
  std::array<std::vector<double>, Rank> at;  ///< One array per axis [m].
  std::vector<double> height2;               ///< Squared distance to the line or plane [m^2].

  [[nodiscard]] std::size_t size() const { return height2.size(); }
  void clear() {
    for (auto& axis : at) axis.clear();
    height2.clear();
  }
};

/// The box around the feet; in the plane with its corners cut at 45 degrees, as far as the feet allow.
template <int Rank>
[[nodiscard]] ConvexRegion<Rank> outline(const Feet<Rank>& feet);

/// delta(region, points), Eq. (3): the largest distance of a place of the region to its nearest point.
template <int Rank>
struct CoverRadius {
  std::optional<double> radius;                 ///< An upper bound [m]; nullopt if the limit is passed.
  typename ConvexRegion<Rank>::Place farthest;  ///< If the limit is passed: a place (nearly) that far away.
};

/// How hard to look.
template <int Rank>
struct CoverSearch {
  double enough = 1.0;  ///< A bound up to this share of the limit will do; a larger one is at most 10 % above the truth (or 10^-6 of the limit).
  const typename ConvexRegion<Rank>::Place* first = nullptr;  ///< A place to look at first, if the region has it.
};

/// Relative rounding that a radius allows for.
inline constexpr double kCoverRounding = 1e-9;

/// The covering radius of a region, up to `limit` [m]. Decided, not sampled: a radius is given if the truth is at most the limit, and none if it
/// is above (or within 10^-6 of it). On a line the truth is found itself; in the plane the distance to a set is 1-Lipschitz, so branch and
/// bound over the region has bounds on both sides. `limit` may be infinite in a sharp search. Nothing reaches an empty set of points. After DeVore
/// et al. [5], whose test samples.
template <int Rank>
[[nodiscard]] CoverRadius<Rank> cover(const ConvexRegion<Rank>& region, const Feet<Rank>& points, double limit, const CoverSearch<Rank>& search);

template <>
CoverRadius<1> cover(const ConvexRegion<1>& region, const Feet<1>& points, double limit, const CoverSearch<1>& search);
template <>
CoverRadius<2> cover(const ConvexRegion<2>& region, const Feet<2>& points, double limit, const CoverSearch<2>& search);

/// The sharp radius alone.
template <int Rank>
[[nodiscard]] std::optional<double> covering_radius(const ConvexRegion<Rank>& region, const Feet<Rank>& points, double limit) {
  return cover<Rank>(region, points, limit, {0.0, nullptr}).radius;
}

}  // namespace vantage
