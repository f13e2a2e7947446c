// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/geometry/vec.h"

namespace vantage {

/// {sin, cos} of an angle [rad] with + - * only (Taylor to degree 17 on [-pi/4, pi/4], error below 1e-15): the same bits on every machine,
/// which libm does not promise.
[[nodiscard]] inline std::array<double, 2> sin_cos(double angle) {
  const double quadrant = std::nearbyint(angle * (2.0 / kPi));
  // pi/2 in two parts, so that multiples of 90 degrees come out clean.
  const double x = (angle - quadrant * 1.5707963267948966) - quadrant * 6.123233995736766e-17;
  const double x2 = x * x;
  double s = 0.0, c = 0.0;
  for (int k = 8; k >= 1; --k) s = (1.0 + s) * (-x2 / ((2.0 * k) * (2.0 * k + 1.0)));
  for (int k = 8; k >= 1; --k) c = (1.0 + c) * (-x2 / ((2.0 * k - 1.0) * (2.0 * k)));
  s = x * (1.0 + s);
  c = 1.0 + c;
  switch (static_cast<long>(quadrant) & 3) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

[[nodiscard]] constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

}  // namespace vantage
