// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "vantage/visibility/depth_image.h"
#include "vantage/visibility/lanes.h"
#include "vantage/visibility/occluder.h"

namespace vantage {

/// A sieve's linear forms along a run: value where w = 0, and change with w.
struct SieveForms {
  bool polygon;
  double value[4], change[4];
  double square;       ///< |direction|^2 = square + w^2.
  double first, step;  ///< Of w.
  double excess, height, slack;
};

/// Tells which pixels of a run an occluder can lower, so that only those are asked with Occluder::range(). It may let a pixel through that does not
/// matter but never stops one that does: tolerances are far above rounding.
template <int Dim>
class Sieve {
 public:
  /// `margin`: the largest by which the occluder is widened [m].
  Sieve(const Occluder<Dim>& occluder, double margin);
  /// The run that the next pixels() ask about.
  void start(const PixelRun<Dim>& run);
  /// One bit, lowest first, for each of `count` (at most kLanes) pixels from the `first` of the run on; `ranges`: theirs so far.
  [[nodiscard]] unsigned pixels(int first, const float* ranges, int count) const;

 private:
  std::array<Vec<Dim>, 4> vector_;  ///< Linear forms of the direction that the test takes.
  SieveForms forms_{};
};

}  // namespace vantage
