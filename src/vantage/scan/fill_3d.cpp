// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>

#include "vantage/base/parallel.h"
#include "vantage/scan/fill.h"
#include "vantage/scan/range_image.h"

namespace vantage {
namespace {

/// Four neighbouring hits, (column, row) order 00 10 01 11.
struct Quad {
  std::array<Vec<3>, 4> corner;
  InversePlane<3> plane;
};

/// The quad at a column and row, if its hits lie on one plane together with neighbours along and across.
bool flat_quad(const RangeImage<3>& image, int c, int r, double spacing, Quad& quad) {
  std::array<double, 4> ranges;
  for (int k = 0; k < 4; ++k) {
    const int i = image.index(c + (k & 1), r + (k >> 1));
    ranges[static_cast<std::size_t>(k)] = image.range(i);
    if (!std::isfinite(ranges[static_cast<std::size_t>(k)])) return false;
    quad.corner[static_cast<std::size_t>(k)] = image.point(i);
  }
  const auto& p = quad.corner;
  const double longest = std::max({(p[1] - p[0]).norm(), (p[3] - p[2]).norm(), (p[2] - p[0]).norm(), (p[3] - p[1]).norm()});
  if (longest < 1.4 * spacing || longest > kWidest * spacing) return false;
  const Vec<3> n = (p[1] - p[0]).cross(p[2] - p[0]);
  const double k = n.dot(p[0]);
  if (std::abs(k) < 1e-12) return false;
  quad.plane = {n / k, InversePlane<3>::tolerance_for(ranges, 2.0 * spacing)};
  const auto on = [&](int dc, int dr) { return quad.plane.holds(image, image.index(c + dc, r + dr)); };
  return on(1, 1) && ((on(-1, 0) && on(-1, 1)) || (on(2, 0) && on(2, 1))) && ((on(0, -1) && on(1, -1)) || (on(0, 2) && on(1, 2)));
}

void sample(const Quad& quad, double spacing, const RangeImage<3>& image, std::vector<Vec<3>>& points) {
  const auto& p = quad.corner;
  const int across = static_cast<int>(std::ceil(std::max((p[1] - p[0]).norm(), (p[3] - p[2]).norm()) / spacing));
  const int along = static_cast<int>(std::ceil(std::max((p[2] - p[0]).norm(), (p[3] - p[1]).norm()) / spacing));
  for (int i = 0; i <= across; ++i)
    for (int j = 0; j <= along; ++j) {
      const double s = static_cast<double>(i) / std::max(across, 1), t = static_cast<double>(j) / std::max(along, 1);
      points.push_back(image.world((1 - t) * ((1 - s) * p[0] + s * p[1]) + t * ((1 - s) * p[2] + s * p[3])));
    }
}

}  // namespace

template <>
std::vector<Vec<3>> fill_between_rays<3>(const Scan<3>& scan, double spacing) {
  const RangeImage<3> image(scan);
  using Points = std::vector<Vec<3>>;
  return parallel_reduce(
      static_cast<std::size_t>(image.columns()), std::size_t{8}, Points{},
      [&](std::size_t begin, std::size_t end) {
        Points points;
        Quad quad;
        for (auto c = static_cast<int>(begin); c < static_cast<int>(end); ++c)
          for (int r = 0; r + 1 < image.rows(); ++r)
            if (flat_quad(image, c, r, spacing, quad)) sample(quad, spacing, image, points);
        return points;
      },
      [](Points& all, Points part) { all.insert(all.end(), part.begin(), part.end()); });
}

}  // namespace vantage
