// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/repeated.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "vantage/scan/rays_around.h"

namespace vantage {
namespace {

constexpr double kRepeated = 0.9;  // Of the points.
constexpr std::size_t kSample = 2000;
constexpr double kCell = 0.002;       // [m]
constexpr double kSame = 0.0009;      // Less than half a cell, so that the cells of a cube's corners hold all of it [m].
constexpr double kMore = 1.5;         // Times as many points: a scan with more shows more.
constexpr double kPlace = 0.05;       // [m]
constexpr double kNoise = 0.05;       // [m]
constexpr double kRangeNoise = 0.01;  // [1]
constexpr double kFinest = 0.7;       // Times the other's step: denser rays show more.
constexpr double kClear = 0.3;        // Before all that was met near by [m].
constexpr double kFloating = 0.01;    // Of the points.

using Points = std::vector<Vec<3>>;
using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t hash = 0;
    for (const std::int64_t x : c) {
      hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

Cell cell_of(const Vec<3>& p) {
  Cell cell;
  for (int a = 0; a < 3; ++a) cell[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(p[a] / kCell));
  return cell;
}

Points in_scanner(const Scan<3>& scan, Points points) {
  for (Vec<3>& p : points) p = scan.world_from_sensor.transpose() * (p - scan.origin);
  return points;
}

Points sample_of(const Points& points) {
  Points sample;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kSample + 1) sample.push_back(points[i]);
  return sample;
}

/// Of the points, those that are among the others.
double share(const Points& points, const Points& others) {
  if (points.empty()) return 0.0;
  std::unordered_multimap<Cell, std::size_t, CellHash> around;
  const Points sample = sample_of(points);
  for (std::size_t i = 0; i < sample.size(); ++i)
    for (int corner = 0; corner < 8; ++corner) {
      const Vec<3> offset(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      around.emplace(cell_of(sample[i] + kSame * offset), i);
    }
  std::vector<std::uint8_t> found(sample.size(), 0);
  for (const Vec<3>& p : others)
    for (auto [at, end] = around.equal_range(cell_of(p)); at != end; ++at)
      if ((sample[at->second] - p).norm() <= kSame) found[at->second] = 1;
  return static_cast<double>(std::count(found.begin(), found.end(), 1)) / static_cast<double>(sample.size());
}

/// The same, of the one that has fewer.
double equal_share(const Points& points, const Points& others) {
  const auto [fewer, more] = std::minmax({points.size(), others.size()});
  if (static_cast<double>(more) > kMore * static_cast<double>(fewer)) return 0.0;
  return points.size() <= others.size() ? share(points, others) : share(others, points);
}

/// What a scan's rays met around the direction of a place.
struct Around {
  double first = kInfinity, last = 0.0;  ///< Hits [m].
  bool known = true;                     ///< All of the rays were fired.
};

Around around(const Scan<3>& scan, const Vec<3>& place) {
  Around around;
  each_ray_around(scan, place, [&](float range, int, int) {
    if (std::isnan(range)) around.known = false;
    if (!std::isfinite(range)) return;
    around.first = std::min(around.first, static_cast<double>(range));
    around.last = std::max(around.last, static_cast<double>(range));
  });
  return around;
}

template <class Test>
double share_of(const Points& points, Test&& test) {
  const Points sample = sample_of(points);
  return static_cast<double>(std::count_if(sample.begin(), sample.end(), test)) / static_cast<double>(std::max<std::size_t>(sample.size(), 1));
}

/// Of the scan's points, those that lie on what the other met.
double in_view_of(const Points& points, const Scan<3>& other) {
  return share_of(points, [&](const Vec<3>& p) {
    const Around met = around(other, p);
    const double distance = (p - other.origin).norm(), noise = kNoise + kRangeNoise * distance;
    return met.first - noise <= distance && distance <= met.last + noise;
  });
}

/// Of the scan's points, those that float in what the other saw to be free.
double floating(const Points& points, const Scan<3>& other) {
  return share_of(points, [&](const Vec<3>& p) {
    const Around met = around(other, p);
    return met.known && (p - other.origin).norm() < std::min(met.first, other.pattern.max_range) - kClear;
  });
}

}  // namespace

std::optional<Repetition> repetition(const Scan<3>& scan, const Scan<3>& other) {
  const Points points = hit_points(scan), others = hit_points(other);
  const double same = equal_share(points, others);
  if (same >= kRepeated) return Repetition{same, "those of"};
  if ((scan.origin - other.origin).norm() <= kPlace && scan.pattern.step >= kFinest * other.pattern.step) {
    const double seen = in_view_of(points, other);
    if (seen >= kRepeated) return Repetition{seen, "seen from the same place in"};
  }
  const double own = equal_share(in_scanner(scan, points), in_scanner(other, others));
  if (own >= kRepeated && floating(points, other) >= kFloating) return Repetition{own, "with another pose those of"};
  return std::nullopt;
}

}  // namespace vantage
