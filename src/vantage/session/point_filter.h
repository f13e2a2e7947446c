// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/scan/bin_points.h"

namespace vantage {

/// Points of a scan that are no surface.
struct FilterOptions {
  /// Mixed pixels: where a beam meets two surfaces, one behind the other, and gives a range between them. Isolated points: rain, dust, birds.
  enum class What { none, mixed, isolated, both } what = What::none;
  double angle = radians(10.0);  ///< Between the ray and the line to a neighbour in the image: below it the line is no surface but a veil [rad].
  double jump = 0.1;             ///< Least difference in range to either neighbour of a mixed pixel [m].
  std::int64_t neighbours = 3;   ///< A point with fewer around it is isolated.
  double radius = 4.0;           ///< Of that, in distances between rays at the point's range.
};

void describe(FilterOptions& options, const OptionVisitor& visit);

struct FilterReport {
  std::int64_t points = 0;  ///< Looked at.
  std::int64_t mixed = 0, isolated = 0;
};

/// Takes out of `points` (world frame) what the options say; `pose` and `step` [rad] are those of the scan's image. A mixed pixel lies, along a row
/// or a column, between a nearer and a farther neighbour, both joined to it by lines steeper than `angle` and at least `jump` longer or shorter; at
/// most three such in a row, for a longer row is a surface seen at a grazing angle; and it does not go on to both sides across, as a pole before a
/// wall does. Isolated points are looked for among those that are left. The order of the rest stays.
[[nodiscard]] FilterReport filter_points(std::vector<Vec<3>>& points, const Pose<3>& pose, double step, const FilterOptions& options);

}  // namespace vantage
