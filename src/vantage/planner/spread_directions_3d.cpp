// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"
#include "vantage/planner/ray_march.h"

namespace vantage {
namespace {

/// Uniform random rotation (Shoemake 1992): a unit quaternion, as a matrix.
Eigen::Matrix3d random_rotation(std::uint64_t seed) {
  Random random(seed);
  const double u = random.uniform();
  const auto [s1, c1] = sin_cos(2.0 * kPi * random.uniform());
  const auto [s2, c2] = sin_cos(2.0 * kPi * random.uniform());
  const double a = std::sqrt(1.0 - u), b = std::sqrt(u);
  const double x = a * s1, y = a * c1, z = b * s2, w = b * c2;
  Eigen::Matrix3d r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y);
  return r;
}

}  // namespace

template <>
std::vector<Vec<3>> spread_directions<3>(std::size_t count, std::uint64_t seed) {
  const Eigen::Matrix3d rotation = random_rotation(seed);
  constexpr double kGoldenTurn = 0.6180339887498949;
  std::vector<Vec<3>> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count), ring = std::sqrt(1.0 - z * z);
    const double turn = static_cast<double>(i) * kGoldenTurn;
    const auto [s, c] = sin_cos(2.0 * kPi * (turn - std::floor(turn)));
    all.emplace_back(rotation * Vec<3>(ring * c, ring * s, z));
  }
  return all;
}

}  // namespace vantage
