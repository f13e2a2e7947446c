// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/scan/scan.h"

namespace vantage {

/// For every hit the plane that the hits around it lie on, in the sensor frame, as N with 1 / range = N . direction [1/m]; zero where there is none,
/// (columns * rows, Dim). `noise` is the standard deviation of the ranges [m]. Around means 12 rays to each side, in space 6, or fewer, or to one
/// side only, whatever comes first: more than four in five of them must be within 3 `noise`, the hit itself too, and no more scattered than
/// noise is, so that no plane goes round a corner or over an edge. Failing that, the plane right around, 3 rays to each side, in space 2, although
/// the hit itself is off it. Depends on the ranges alone; same bits for any number of threads.
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> local_planes(const Scan<Dim>& scan, double noise);

struct Smoothed {
  std::int64_t moved = 0, dropped = 0;  ///< Hits.
};

/// Puts hits onto their planes, along their rays, and turns those into kNoData that are off them by more than 3 `noise` [m]. What has no plane stays
/// as it is: edges, leaves, wires. Steps and bends of less than the noise are lost. With no noise nothing is done.
template <int Dim>
Smoothed put_on_planes(Scan<Dim>& scan, double noise);

}  // namespace vantage
