// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/fill.h"
#include "vantage/scan/range_image.h"

namespace vantage {

template <>
std::vector<Vec<2>> fill_between_rays<2>(const Scan<2>& scan, double spacing) {
  const RangeImage<2> image(scan);
  std::vector<Vec<2>> points;
  for (int c = 0; c < image.columns(); ++c) {
    const int i = image.index(c, 0), j = image.index(c + 1, 0);
    const std::array ranges{image.range(i), image.range(j)};
    if (!std::isfinite(ranges[0]) || !std::isfinite(ranges[1])) continue;
    const Vec<2> a = image.point(i), b = image.point(j);
    const double gap = (b - a).norm();
    if (gap < 1.4 * spacing || gap > kWidest * spacing) continue;
    const Vec<2> n(b[1] - a[1], a[0] - b[0]);
    const double k = n.dot(a);
    if (std::abs(k) < 1e-12) continue;
    const InversePlane<2> line{n / k, InversePlane<2>::tolerance_for(ranges, 2.0 * spacing)};
    if (!line.holds(image, image.index(c - 1, 0)) && !line.holds(image, image.index(c + 2, 0))) continue;
    const int steps = static_cast<int>(std::ceil(gap / spacing));
    for (int s = 1; s < steps; ++s) points.push_back(image.world(a + (b - a) * (static_cast<double>(s) / steps)));
  }
  return points;
}

}  // namespace vantage
