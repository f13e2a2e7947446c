// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/scan/scan.h"

namespace vantage {

/// How much of a scan another one holds.
struct SharedPoints {
  double share = 0.0;      ///< Of up to 2,000 of its points, those that the other has, too, to within 0.4 mm.
  bool elsewhere = false;  ///< They are equal seen from the scanners, not in the world: one scan with two poses. Level ground does not count for it.
};

/// Two scans of one place share next to nothing so exactly; a scan given twice shares all.
[[nodiscard]] SharedPoints shared_points(const Scan<3>& scan, const Scan<3>& other);

}  // namespace vantage
