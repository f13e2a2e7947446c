// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/repeated.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace vantage {
namespace {

constexpr std::size_t kSample = 2000;
constexpr double kCell = 0.001;   // [m]
constexpr double kSame = 0.0004;  // Less than half a cell, so that the cells of a cube's corners hold all of it [m].
constexpr double kClearly = 0.05;

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

/// The points, in the world's frame or the scanner's.
std::vector<Vec<3>> points_in(const Scan<3>& scan, bool of_scanner) {
  std::vector<Vec<3>> points = scan.points.empty() ? hit_points(scan) : scan.points;
  if (of_scanner)
    for (Vec<3>& p : points) p = scan.world_from_sensor.transpose() * (p - scan.origin);
  return points;
}

double share(const std::vector<Vec<3>>& points, const std::vector<Vec<3>>& others) {
  if (points.empty()) return 0.0;
  std::unordered_multimap<Cell, std::size_t, CellHash> around;
  std::vector<Vec<3>> sample;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kSample + 1) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec<3> offset(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      around.emplace(cell_of(points[i] + kSame * offset), sample.size());
    }
    sample.push_back(points[i]);
  }
  std::vector<std::uint8_t> found(sample.size(), 0);
  for (const Vec<3>& p : others)
    for (auto [at, end] = around.equal_range(cell_of(p)); at != end; ++at)
      if ((sample[at->second] - p).norm() <= kSame) found[at->second] = 1;
  return static_cast<double>(std::count(found.begin(), found.end(), 1)) / static_cast<double>(sample.size());
}

/// Without those at the commonest height, unless hardly any others are left: the same scanner sees level ground alike from everywhere.
std::vector<Vec<3>> off_ground(std::vector<Vec<3>> points) {
  constexpr double kLayer = 0.02;  // [m]
  constexpr std::size_t kEnough = 20;
  std::unordered_map<std::int64_t, std::size_t> layers;
  const auto layer = [](const Vec<3>& p) { return static_cast<std::int64_t>(std::floor(p.z() / kLayer + 0.5)); };
  for (const Vec<3>& p : points) ++layers[layer(p)];
  std::pair<std::size_t, std::int64_t> most{0, 0};
  for (const auto& [height, count] : layers) most = std::max(most, {count, height});
  std::vector<Vec<3>> kept;
  for (const Vec<3>& p : points)
    if (std::abs(layer(p) - most.second) > 1) kept.push_back(p);
  return kept.size() >= kEnough ? kept : points;
}

}  // namespace

SharedPoints shared_points(const Scan<3>& scan, const Scan<3>& other) {
  const double world = share(points_in(scan, false), points_in(other, false));
  const double own = share(off_ground(points_in(scan, true)), points_in(other, true));
  return {std::max(world, own), own > world + kClearly};
}

}  // namespace vantage
