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

/// Angle of (x, y) in (-pi, pi], 0 for the origin [rad]; + - * / only, error below 1e-10.
[[nodiscard]] inline double angle_of(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y), big = std::max(ax, ay);
  if (!(big > 0.0)) return 0.0;
  double z = std::min(ax, ay) / big;  // tan of an angle up to 45 degrees,
  const bool fold = z > 0.41421356237309503;
  if (fold) z = (z - 1.0) / (z + 1.0);  // brought to 22.5.
  const double z2 = z * z;
  double sum = 0.0;
  for (int k = 23; k >= 1; k -= 2) sum = 1.0 / k - z2 * sum;
  double angle = z * sum + (fold ? 0.25 * kPi : 0.0);
  if (ay > ax) angle = 0.5 * kPi - angle;
  if (x < 0.0) angle = kPi - angle;
  return y < 0.0 ? -angle : angle;
}

[[nodiscard]] constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

}  // namespace vantage
