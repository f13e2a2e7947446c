// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "vantage/surface/proof.h"

namespace vantage {

/// A triangle's least height.
template <>
double width<2>(const std::array<Vec<2>, 3>& simplex) {
  const Vec<2> a = simplex[1] - simplex[0], b = simplex[2] - simplex[0];
  const double twice_area = std::abs(a[0] * b[1] - a[1] * b[0]);
  const double base2 = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  return base2 > 0.0 ? twice_area / std::sqrt(base2) : 0.0;
}

}  // namespace vantage
