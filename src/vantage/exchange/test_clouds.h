// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/base/random.h"
#include "vantage/geometry/vec.h"

namespace vantage {

/// A scan of a corner: floor and wall (in the plane two walls), dense near `at` and thin far away, with noise, a wire, and stray points.
template <int Dim>
std::vector<Vec<Dim>> corner_scan(std::size_t count, const Vec<Dim>& at, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec<Dim>> points;
  for (std::size_t i = 0; i < count; ++i) {
    Vec<Dim> p;
    const double reach = 0.3 + 4.0 * random.uniform() * random.uniform();
    for (int a = 0; a < Dim; ++a) p[a] = at[a] + reach * random.normal();
    const std::uint64_t kind = random.below(20);
    if (kind < 10)
      p[Dim - 1] = 0.01 * random.normal();
    else if (kind < 17)
      p[0] = 2.0 + 0.1 * p[Dim - 1] + 0.01 * random.normal();
    else if (kind < 19)
      p.template tail<Dim - 1>().setConstant(1.5);
    points.push_back(p);
  }
  return points;
}

}  // namespace vantage
