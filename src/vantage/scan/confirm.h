// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "vantage/scan/scan.h"

namespace vantage {

/// Turns hits that stand alone, strays of dust, rain or a false echo, into kNoData, and says how many: those with which too few of the rays around
/// (two on each side, and in space two above and below) hit at a like range: none, in space fewer than three. Ranges are alike that differ by less
/// than ten times the distance between rays there, which a wall at 6 degrees to the ray still does not exceed (in space four times: along some of the
/// rays around the range hardly changes), or than 4 `noise` [m]. What so few rays meet, a wire or a thin pole, is lost with them. Depends on the
/// ranges alone, not on any order.
template <int Dim>
std::int64_t drop_unconfirmed(Scan<Dim>& scan, double noise);

}  // namespace vantage
