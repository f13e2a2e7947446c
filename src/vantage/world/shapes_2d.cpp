// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/shapes_2d.h"

#include <algorithm>

#include "vantage/geometry/angle.h"

namespace vantage {

void add_polygon(Mesh<2>& mesh, std::span<const Vec<2>> corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto count = static_cast<std::uint32_t>(corners.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  for (std::uint32_t i = 0; i < count; ++i) mesh.facets.push_back({first + i, first + (i + 1) % count});
}

std::vector<Vec<2>> round_polygon(const Vec<2>& center, int sides, const std::function<double(double)>& radius) {
  std::vector<Vec<2>> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = i * (2.0 * kPi / sides);
    const auto [s, c] = sin_cos(angle);
    corners.push_back(center + radius(angle) * Vec<2>(c, s));
  }
  return corners;
}

std::vector<Disc> scatter_discs(const Box<2>& region, int count, const std::array<double, 2>& radii, double gap, const Disc& keep_free,
                                Random& random) {
  std::vector<Disc> discs;
  const auto fits = [&](const Disc& disc) {
    const auto apart = [&](const Disc& other) { return (disc.center - other.center).norm() >= disc.radius + other.radius + gap; };
    return apart(keep_free) && std::all_of(discs.begin(), discs.end(), apart);
  };
  while (static_cast<int>(discs.size()) < count) {
    Disc disc{Vec<2>::Zero(), random.uniform(radii[0], radii[1])};
    do {
      for (int a = 0; a < 2; ++a) disc.center[a] = random.uniform(region.low[a] + disc.radius, region.high[a] - disc.radius);
      disc.radius *= 0.995;
    } while (!fits(disc));
    discs.push_back(disc);
  }
  return discs;
}

}  // namespace vantage
