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

/// delta(region, points), Eq. (3): the largest distance of a place of the region to its nearest point [m]. Decided, not sampled: the distance to
/// a set is 1-Lipschitz, so branch and bound over the region has bounds on both sides. Returns an upper bound that is <= `limit` and at most
/// 10 % above the truth (or above 10^-6 of a finite limit), or nullopt if the truth is above the limit (or within 10^-6 of it). `limit` may be
/// infinite. Nothing reaches an empty set of points. After DeVore et al. [5], whose test samples.
template <int Rank>
[[nodiscard]] std::optional<double> covering_radius(const ConvexRegion<Rank>& region, const Feet<Rank>& points, double limit);

}  // namespace vantage
