// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <optional>

#include "vantage/geometry/angle.h"
#include "vantage/scan/scan.h"

namespace vantage {

/// Column and row of a ray; neither need be in the pattern.
struct RayPlace {
  int column = 0, row = 0;
};

/// The ray nearest to the direction of a place in the world.
template <int Dim>
[[nodiscard]] RayPlace ray_towards(const Scan<Dim>& scan, const Vec<Dim>& place) {
  const ScanPattern& pattern = scan.pattern;
  const Vec<Dim> local = scan.world_from_sensor.transpose() * (place - scan.origin);
  const auto ray = [](double angle, double step) { return static_cast<int>(std::lround(angle / step)); };
  const double across = pattern.full_circle() ? 2.0 * kPi / pattern.columns() : pattern.step;
  const double up = angle_of((Dim - 2) * local[Dim - 1], local.template head<2>().norm());
  return {ray(angle_of(local[1], local[0]) - pattern.azimuth(0), across), (Dim - 2) * ray(up - pattern.elevation(0), pattern.step)};
}

/// Number of a ray among the ranges; columns go round a full circle. None if the pattern does not have it.
template <int Dim>
[[nodiscard]] std::optional<std::size_t> number_of(const ScanPattern& pattern, const RayPlace& ray) {
  const int columns = pattern.columns(), rows = pattern.template rows<Dim>();
  const int column = pattern.full_circle() ? (ray.column % columns + columns) % columns : ray.column;
  if (column < 0 || column >= columns || ray.row < 0 || ray.row >= rows) return std::nullopt;
  return static_cast<std::size_t>(column * rows + ray.row);
}

/// Range of a ray; kNoData if the pattern does not have it.
template <int Dim>
[[nodiscard]] float range_of(const Scan<Dim>& scan, const RayPlace& ray) {
  const auto number = number_of<Dim>(scan.pattern, ray);
  return number ? scan.ranges[*number] : kNoData;
}

/// Unit direction in the sensor frame by sine and cosine of its angles.
template <int Dim>
[[nodiscard]] Vec<Dim> direction_of(const std::array<double, 2>& azimuth, const std::array<double, 2>& elevation) {
  Vec<Dim> d;
  d[0] = elevation[1] * azimuth[1];
  d[1] = elevation[1] * azimuth[0];
  for (int a = 2; a < Dim; ++a) d[a] = elevation[0];
  return d;
}

/// Unit direction of a ray in the sensor frame: as directions() has it.
template <int Dim>
[[nodiscard]] Vec<Dim> ray_direction(const ScanPattern& pattern, const RayPlace& ray) {
  return direction_of<Dim>(sin_cos(pattern.azimuth(ray.column)), sin_cos((Dim - 2) * pattern.elevation(ray.row)));
}

/// Calls `visit(range, across, up)` for the ray nearest to a place and those beside it: `across` columns, -1 to 1, and `up` rows, in the plane 0.
template <int Dim, class Visit>
void each_ray_around(const Scan<Dim>& scan, const Vec<Dim>& place, Visit&& visit) {
  const RayPlace ray = ray_towards(scan, place);
  for (int across = -1; across <= 1; ++across)
    for (int up = 2 - Dim; up <= Dim - 2; ++up) visit(range_of(scan, {ray.column + across, ray.row + up}), across, up);
}

}  // namespace vantage
