// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "vantage/scan/scan.h"

namespace vantage {

/// Turns hits that stand alone, strays of dust, rain or a false echo, into kNoData, and says how many: those of whose rays around (two on each side,
/// and in space two above and below) none hit at a like range. Ranges are alike that differ by ten times the distance between rays there, which a
/// wall at 6 degrees to the ray still does not, or by 4 `noise` [m]. What only one ray meets, a wire or a thin pole, is lost with them. Depends on
/// the ranges alone, not on any order.
template <int Dim>
std::int64_t drop_unconfirmed(Scan<Dim>& scan, double noise);

}  // namespace vantage
