// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/moved.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "vantage/base/parallel.h"
#include "vantage/scan/rays_around.h"

namespace vantage {
namespace {

constexpr double kSpacings = 2.0;  // Distances between rays that count as at the point.
constexpr double kWidest = 60.0;   // Rays to each side that are looked at.
constexpr int kJoint = 3;          // Rays between hits that are joined by a line, at most.
constexpr std::size_t kChunk = 256;

/// Whether the scan's rays around a place go on behind it.
template <int Dim>
bool looks_through(const Scan<Dim>& scan, const Vec<Dim>& place, double gap) {
  const double range = (place - scan.origin).norm();
  if (range < scan.pattern.min_range || range > scan.pattern.max_range) return false;
  bool ended = false;
  std::array<bool, std::size_t{2 * (Dim - 1)}> through{};  // To the left and right, in space below and above.
  each_ray_around(scan, place, [&](float ray, int across, int up) {
    const double behind = static_cast<double>(ray) - range;  // Infinite if nothing was met, NaN if nothing is known.
    ended = ended || behind <= gap;
    if (!(behind > gap)) return;
    const std::array<int, 2> beside = {across, up};
    for (std::size_t a = 0; a < Dim - 1; ++a)
      if (beside[a] != 0) through[2 * a + (beside[a] > 0 ? 1 : 0)] = true;
  });
  return !ended && std::all_of(through.begin(), through.end(), [](bool side) { return side; });
}

template <int Dim>
double distance_to_line(const Vec<Dim>& p, const Vec<Dim>& a, const Vec<Dim>& b) {
  const Vec<Dim> line = b - a;
  const double length = line.squaredNorm();
  return (p - a - (length > 0.0 ? std::clamp((p - a).dot(line) / length, 0.0, 1.0) : 0.0) * line).norm();
}

/// Whether the scan met something within `gap` of a place: a hit, or a line between two that follow each other along a column (in the plane along
/// the circle), as the rings on the ground do.
template <int Dim>
bool meets(const Scan<Dim>& scan, const Vec<Dim>& place, double gap) {
  const Vec<Dim> local = scan.world_from_sensor.transpose() * (place - scan.origin);
  const ScanPattern& pattern = scan.pattern;
  const RayPlace middle = ray_towards(scan, place);
  const int wide = static_cast<int>(std::min(kWidest, gap / (local.norm() * pattern.step))) + 1, lines = (Dim - 2) * wide;
  for (int line = -lines; line <= lines; ++line) {
    std::optional<Vec<Dim>> last;
    int since = 0;
    for (int k = -wide - kJoint; k <= wide + kJoint; ++k, ++since) {
      const RayPlace ray{middle.column + std::array{k, line}[Dim - 2], middle.row + (Dim - 2) * k};
      const float range = range_of(scan, ray);
      if (!std::isfinite(range)) continue;
      const Vec<Dim> hit = static_cast<double>(range) * ray_direction<Dim>(pattern, ray);
      if (distance_to_line<Dim>(local, last && since <= kJoint ? *last : hit, hit) <= gap) return true;
      last = hit;
      since = 0;
    }
  }
  return false;
}

template <int Dim>
bool has_moved(const std::vector<Scan<Dim>>& scans, std::size_t own, const Vec<Dim>& place, double gap) {
  const auto reach = [&](std::size_t k) { return std::max(gap, kSpacings * scans[k].pattern.step * (place - scans[k].origin).norm()); };
  bool through = false;
  for (std::size_t k = 0; k < scans.size() && !through; ++k) through = k != own && looks_through(scans[k], place, std::max(reach(own), reach(k)));
  for (std::size_t k = 0; k < scans.size() && through; ++k) through = k == own || !meets(scans[k], place, std::max(reach(own), reach(k)));
  return through;
}

}  // namespace

template <int Dim>
std::vector<std::vector<std::size_t>> moved_points(const std::vector<Scan<Dim>>& scans, double gap) {
  std::vector<std::vector<std::size_t>> all(scans.size());
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::vector<Vec<Dim>> points = hit_points(scans[k]);
    std::vector<std::uint8_t> moved(points.size(), 0);
    parallel_for(points.size(), kChunk, [&](std::size_t i) { moved[i] = has_moved(scans, k, points[i], gap) ? 1 : 0; });
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (moved[i] != 0) all[k].push_back(i);
  }
  return all;
}

template <int Dim>
Scan<Dim> without_points(Scan<Dim> scan, const std::vector<std::size_t>& numbers) {
  if (scan.points.empty()) {
    std::size_t hit = 0;
    for (float& range : scan.ranges)
      if (std::isfinite(range) && std::binary_search(numbers.begin(), numbers.end(), hit++)) range = kNoData;
    return scan;
  }
  if (scan.points.size() == numbers.size()) std::fill(scan.ranges.begin(), scan.ranges.end(), kNoData);
  for (const std::size_t number : numbers) {
    const double range = (scan.points[number] - scan.origin).norm(), near = kSpacings * scan.pattern.step * range;
    const RayPlace middle = ray_towards(scan, scan.points[number]);
    for (int across = -1; across <= 1; ++across)
      for (int up = 2 - Dim; up <= Dim - 2; ++up)
        if (const auto ray = number_of<Dim>(scan.pattern, {middle.column + across, middle.row + up}))
          if (std::abs(static_cast<double>(scan.ranges[*ray]) - range) <= near) scan.ranges[*ray] = kNoData;
  }
  std::size_t point = 0;
  std::erase_if(scan.points, [&](const Vec<Dim>&) { return std::binary_search(numbers.begin(), numbers.end(), point++); });
  return scan;
}

template std::vector<std::vector<std::size_t>> moved_points(const std::vector<Scan<2>>&, double);
template std::vector<std::vector<std::size_t>> moved_points(const std::vector<Scan<3>>&, double);
template Scan<2> without_points(Scan<2>, const std::vector<std::size_t>&);
template Scan<3> without_points(Scan<3>, const std::vector<std::size_t>&);

}  // namespace vantage
