// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "vantage/base/random.h"
#include "vantage/geometry/mesh.h"

namespace vantage {

/// Circle of a rejection: no two of them come closer than the gap asked for.
struct Disc {
  Vec<2> center;  ///< [m]
  double radius;  ///< [m]
};

/// Adds the closed polygon through `corners` (counterclockwise when solid) [m].
void add_polygon(Mesh<2>& mesh, std::span<const Vec<2>> corners);

/// Closed curve of `sides` corners round a centre: `radius(angle)` [m] at angle [rad].
[[nodiscard]] std::vector<Vec<2>> round_polygon(const Vec<2>& center, int sides, const std::function<double(double)>& radius);

/// `count` discs inside `region`, at least `gap` from each other and from `keep_free` [m]. Radii are uniform in `radii`; a disc that finds no
/// place shrinks until it does.
[[nodiscard]] std::vector<Disc> scatter_discs(const Box<2>& region, int count, const std::array<double, 2>& radii, double gap, const Disc& keep_free,
                                              Random& random);

}  // namespace vantage
