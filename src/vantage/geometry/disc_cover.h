// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "vantage/geometry/hausdorff.h"

namespace vantage {

/// A place of the region that is farther than `limit` [m] from all points (or within 10^-6 of that), or nullopt: there is none. The points serve
/// discs; where these leave a gap, its border has a corner: on the region's border, or where two circles cross. For few points: quadratic time, times
/// the discs that have to be asked before one holds a corner.
[[nodiscard]] std::optional<ConvexRegion<2>::Place> find_uncovered(const ConvexRegion<2>& region, const Feet<2>& points, double limit);

}  // namespace vantage
