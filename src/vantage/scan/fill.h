// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/scan/scan.h"

namespace vantage {

/// Points at most `spacing` apart on the flat surfaces between neighbouring hits, (N, Dim) [m]. On a plane the inverse range is linear in the direction, at a
/// depth jump it is not: the gap between neighbours is filled only where hits on both sides of it, along and across, lie on its plane. Nothing is
/// invented, so a wall hit by two columns only stays unfilled. Gaps under 1.4 or over 5 spacings are left alone: with samples h/2 apart, a door
/// of three lattice steps that falls between two rays is never closed. For knowing walls, never
/// for the reconstruction or its certificate.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] std::vector<Vec<Dim>> fill_between_rays(const Scan<Dim>& scan, double spacing);

template <>
std::vector<Vec<2>> fill_between_rays<2>(const Scan<2>& scan, double spacing);
template <>
std::vector<Vec<3>> fill_between_rays<3>(const Scan<3>& scan, double spacing);

}  // namespace vantage
