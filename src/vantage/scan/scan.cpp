// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/scan.h"

#include <cmath>

#include "vantage/scan/rays_around.h"

namespace vantage {
namespace {

int steps(double fov, double step) { return static_cast<int>(std::floor(fov / step + 1e-6)); }

}  // namespace

int ScanPattern::columns() const { return full_circle() ? steps(2.0 * kPi, step) : steps(horizontal_fov, step) + 1; }

template <>
int ScanPattern::rows<2>() const {
  return 1;
}

template <>
int ScanPattern::rows<3>() const {
  return steps(vertical_fov, step) + 1;
}

double ScanPattern::azimuth(int column) const {
  return full_circle() ? -kPi + column * (2.0 * kPi / columns()) : (column - 0.5 * (columns() - 1)) * step;
}

double ScanPattern::elevation(int row) const { return (row - 0.5 * (rows<3>() - 1)) * step; }

void describe(ScanPattern& p, const OptionVisitor& visit) {
  visit.angle("step_deg", p.step, Range{0.01, 30.0}, "angle between neighbouring rays");
  visit.angle("horizontal_fov_deg", p.horizontal_fov, Range{1.0, 360.0}, "horizontal field of view");
  visit.angle("vertical_fov_deg", p.vertical_fov, Range{1.0, 180.0}, "vertical field of view (3D)");
  visit("min_range", p.min_range, "m", Range{0.0, 1e4}, "nearer surfaces give no data");
  visit("range", p.max_range, "m", Range{1e-3, 1e5}, "farther surfaces give no return");
}

template <int Dim>
std::vector<Vec<Dim>> directions(const ScanPattern& pattern) {
  const int columns = pattern.columns(), rows = pattern.rows<Dim>();
  std::vector<std::array<double, 2>> elevations;
  for (int r = 0; r < rows; ++r) elevations.push_back(sin_cos((Dim - 2) * pattern.elevation(r)));
  std::vector<Vec<Dim>> all;
  all.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int c = 0; c < columns; ++c) {
    const std::array<double, 2> azimuth = sin_cos(pattern.azimuth(c));
    for (int r = 0; r < rows; ++r) all.push_back(direction_of<Dim>(azimuth, elevations[static_cast<std::size_t>(r)]));
  }
  return all;
}

template <int Dim>
std::vector<Vec<Dim>> hit_points(const Scan<Dim>& scan) {
  if (!scan.points.empty()) return scan.points;
  const std::vector<Vec<Dim>> rays = directions<Dim>(scan.pattern);
  std::vector<Vec<Dim>> points;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (std::isfinite(scan.ranges[i])) points.push_back(scan.origin + scan.world_from_sensor * rays[i] * static_cast<double>(scan.ranges[i]));
  return points;
}

template std::vector<Vec<2>> directions<2>(const ScanPattern&);
template std::vector<Vec<3>> directions<3>(const ScanPattern&);
template std::vector<Vec<2>> hit_points<2>(const Scan<2>&);
template std::vector<Vec<3>> hit_points<3>(const Scan<3>&);

}  // namespace vantage
