// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/base/parallel.h"
#include "vantage/visibility/depth_image.h"

namespace vantage {
namespace {

/// Column and row, as real numbers, of a direction in the sensor frame; row 0 in 2D.
template <int Dim>
std::array<double, 2> image_place(const ScanPattern& pattern, const Vec<Dim>& d) {
  const double azimuth = angle_of(d[1], d[0]);
  const double column =
      pattern.full_circle() ? (azimuth + kPi) / (2.0 * kPi) * pattern.columns() : azimuth / pattern.step + 0.5 * (pattern.columns() - 1);
  const double height = (Dim - 2) * d[Dim - 1];
  const double elevation = angle_of(height, d.template head<2>().norm());
  return {column, elevation / pattern.step + 0.5 * (pattern.rows<Dim>() - 1)};
}

/// Free range along a ray for the nodes near it.
float free_range(float range, double max_range) {
  if (std::isnan(range)) return 0.0F;
  return std::isinf(range) ? static_cast<float>(max_range) : range;
}

template <int Dim>
float least_of_neighbours(const Scan<Dim>& scan, const Vec<Dim>& direction) {
  const ScanPattern& pattern = scan.pattern;
  const int columns = pattern.columns(), rows = pattern.rows<Dim>();
  const auto [column, row] = image_place<Dim>(pattern, scan.world_from_sensor.transpose() * direction);
  const bool wraps = pattern.full_circle();
  constexpr double kHalf = 0.5 + 1e-9;  // A ray stands for half a step on each side.
  if (!wraps && (column < -kHalf || column > columns - 1 + kHalf)) return 0.0F;
  if (row < -kHalf || row > rows - 1 + kHalf) return 0.0F;
  const int c0 = static_cast<int>(std::floor(column)), r0 = static_cast<int>(std::floor(row));
  float least = std::numeric_limits<float>::infinity();
  for (const int c : {c0, c0 + 1})
    for (const int r : {r0, r0 + 1}) {
      const int cc = wraps ? (c % columns + columns) % columns : std::clamp(c, 0, columns - 1);
      least = std::min(least, free_range(scan.range(cc, std::clamp(r, 0, rows - 1)), pattern.max_range));
    }
  return least;
}

}  // namespace

template <int Dim>
void draw_ranges(DepthImage<Dim>& image, const Scan<Dim>& scan) {
  parallel_for(image.size(), 1 << 12, [&](std::size_t p) { image[p] = std::min(image[p], least_of_neighbours(scan, image.direction(p))); });
}

template void draw_ranges<2>(DepthImage<2>&, const Scan<2>&);
template void draw_ranges<3>(DepthImage<3>&, const Scan<3>&);

}  // namespace vantage
