// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "vantage/visibility/depth_image.h"
#include "vantage/visibility/lanes.h"
#include "vantage/visibility/occluder.h"

namespace vantage {

/// Tells which pixels of a run an occluder can lower, so that only those are asked with Occluder::range(). It may let a pixel through that does not
/// matter but never stops one that does: tolerances are far above rounding.
template <int Dim>
class Sieve {
 public:
  /// `margin`: the largest by which the occluder is widened [m].
  Sieve(const Occluder<Dim>& occluder, double margin);
  /// One bit per pixel of the first `count` (at most kLanes) of the run whose ranges so far are `ranges`; lowest bit first.
  [[nodiscard]] unsigned pixels(const PixelRun<Dim>& run, const float* ranges, int count) const;

 private:
  bool flat_;                       ///< A polygon; else a segment or point.
  std::array<Vec<Dim>, 4> vector_;  ///< Of the linear forms of the direction that the test takes.
  double square_, height_, slack_;
};

}  // namespace vantage
