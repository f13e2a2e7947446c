// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/scan/scan.h"

namespace vantage {

/// What stood in one scan and not in another: people, cars, doors. A point has moved if another scan looks through it, and if no other scan met
/// anything within `gap` [m] of it, or within twice the distance between the rays of either scan there, if that is more. A scan looks through a point
/// if of its 3 x 3 rays (in the plane 3) nearest to it some go on behind it on every side, left and right, below and above, and none ends before it
/// or at it. What it met are its hits and the lines between hits that follow each other along a column: ground between two rings is met. Thin things
/// may be looked past from afar: a wire that only one scan hits is taken for moved where another's rays leave it out. Returns for every scan the
/// numbers of those hit_points, ascending; the same for any order of the scans, same bits for any number of threads.
template <int Dim>
[[nodiscard]] std::vector<std::vector<std::size_t>> moved_points(const std::vector<Scan<Dim>>& scans, double gap);

/// A scan without these hit_points, given ascending. Their rays give no data: neither a surface nor what is free before it is known by them. Of a
/// scan that keeps points besides its rays these are the 3 x 3 nearest to each, those that end there.
template <int Dim>
[[nodiscard]] Scan<Dim> without_points(Scan<Dim> scan, const std::vector<std::size_t>& numbers);

}  // namespace vantage
