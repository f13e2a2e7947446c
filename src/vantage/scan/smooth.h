// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/scan/scan.h"

namespace vantage {

/// For every ray the plane that the hits around it lie on, in the sensor frame, as N with 1 / range = N . direction [1/m]; zero where there is none,
/// (columns * rows, Dim). `noise` is the standard deviation of the ranges [m]. Around means 12 rays to each side, in space 6 by 6; where those
/// hits are not within the noise of one plane, beside the ray, or fewer. Four in five of them must be within 3 `noise`, the ray's own too, and no more scattered
/// than noise is: no plane goes round a corner or over an edge. Depends on the ranges alone; same bits for any number of threads.
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> local_planes(const Scan<Dim>& scan, double noise);

/// Puts every hit onto its plane, along its ray, and says how many. What has no plane stays: edges, leaves, wires, and what is off by
/// more than 3 `noise` [m]. Steps and bends of less than the noise go with it. With no noise nothing is done.
template <int Dim>
std::int64_t put_on_planes(Scan<Dim>& scan, double noise);

}  // namespace vantage
