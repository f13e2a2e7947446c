// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"
#include "vantage/planner/ray_march.h"

namespace vantage {

template <>
std::vector<Vec<2>> spread_directions<2>(std::size_t count, std::uint64_t seed) {
  const double turn = Random(seed).uniform();
  std::vector<Vec<2>> all;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [s, c] = sin_cos(2.0 * kPi * ((static_cast<double>(i) + turn) / static_cast<double>(count)));
    all.emplace_back(c, s);
  }
  return all;
}

}  // namespace vantage
