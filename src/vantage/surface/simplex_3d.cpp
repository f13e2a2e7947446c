// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vantage/surface/proof.h"

namespace vantage {

/// The narrowest pair of planes holds a face and a vertex, or two opposite edges: six times the volume over twice the area they span.
template <>
double width<3>(const std::array<Vec<3>, 4>& simplex) {
  const Vec<3> a = simplex[1] - simplex[0], b = simplex[2] - simplex[0], c = simplex[3] - simplex[0];
  const Vec<3> x = a.cross(b), y = b.cross(c), z = c.cross(a);
  const double faces2 = std::max({x.squaredNorm(), y.squaredNorm(), z.squaredNorm(), (x + y + z).squaredNorm()});
  const double edges2 = std::max({(x + z).squaredNorm(), (x + y).squaredNorm(), (y + z).squaredNorm()});
  const double base2 = std::max(faces2, edges2);
  return base2 > 0.0 ? std::abs(a.dot(y)) / std::sqrt(base2) : 0.0;
}

}  // namespace vantage
