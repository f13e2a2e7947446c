// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"
#include "vantage/world/find_start.h"
#include "vantage/world/inside_solid.h"

namespace vantage {
namespace {

constexpr int kColumns = 24;             ///< Along either side.
constexpr int kLevels = 8;               ///< Of the lattice in mid-air.
constexpr double kEyeHeight = 1.7;       ///< [m]
constexpr double kAboveClearance = 1.1;  ///< So that the ground itself is clear in a place of large cells.
constexpr int kAzimuths = 32;
constexpr std::array<double, 2> kRises{0.03, 0.15};  ///< Sines.

/// Middle of cell i of n between low and high.
double middle(double low, double high, int i, int n) { return low + (high - low) * (i + 0.5) / n; }

/// Height of the lowest surface over `bounds` at (x, y), coming from below.
std::optional<double> lowest_surface(const RayCaster<3>& world, const Box<3>& bounds, double x, double y) {
  const double below = bounds.low[2] - 0.1, range = world.cast({x, y, below}, Vec<3>::UnitZ(), bounds.high[2] - below).range;
  return range < kInfinity ? std::optional(below + range) : std::nullopt;
}

/// Mean range of the rays around the horizon, a little upwards so that the ground does not count; those that meet nothing count 0 [m].
double view(const RayCaster<3>& world, const Vec<3>& p, double range) {
  double sum = 0.0;
  for (int i = 0; i < kAzimuths; ++i) {
    const auto [s, c] = sin_cos((i + 0.5) * (2.0 * kPi / kAzimuths));
    for (const double rise : kRises) {
      const double flat = std::sqrt(1.0 - rise * rise), met = world.cast(p, {flat * c, flat * s, rise}, range).range;
      sum += met < kInfinity ? met : 0.0;
    }
  }
  return sum / static_cast<double>(kAzimuths * kRises.size());
}

/// The place of the best positive score that is not within a solid, the first of equals.
template <class Score>
std::optional<Vec<3>> best_of(const RayCaster<3>& world, const std::vector<Vec<3>>& places, Score&& score) {
  std::vector<double> scores(places.size());
  parallel_for(places.size(), 4, [&](std::size_t i) { scores[i] = score(places[i]); });
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  for (const std::size_t i : order)
    if (scores[i] > 0.0 && !inside_solid<3>(world, places[i])) return places[i];
  return std::nullopt;
}

}  // namespace

double ground_level(const RayCaster<3>& world, const Box<3>& bounds) {
  std::vector<double> heights;
  for (int i = 0; i < kColumns * kColumns; ++i)
    if (const auto z = lowest_surface(world, bounds, middle(bounds.low[0], bounds.high[0], i % kColumns, kColumns),
                                      middle(bounds.low[1], bounds.high[1], i / kColumns, kColumns)))
      heights.push_back(*z);
  if (heights.empty()) return bounds.low[2];
  std::sort(heights.begin(), heights.end());
  const double median = heights[heights.size() / 2];
  const auto level = std::count_if(heights.begin(), heights.end(), [&](double z) { return std::abs(z - median) <= 0.25; });
  return 2 * level >= kColumns * kColumns ? median : bounds.low[2];
}

Vec<3> find_start(const RayCaster<3>& world, const Box<3>& domain, const StartNeeds& needs) {
  const Vec<3> size = domain.size(), center = domain.center();
  const double eye = std::min(std::max(kEyeHeight, kAboveClearance * needs.clearance), 0.5 * size[2]), half = 0.5 * size.head<2>().norm();
  const auto score = [&](const Vec<3>& p) {
    if (world.distance(p, needs.clearance) < needs.clearance) return 0.0;
    const double off = (p - center).head<2>().norm() / half;
    return view(world, p, needs.range) * (1.0 - 0.5 * off);
  };
  std::vector<Vec<3>> standing, floating;
  for (int i = 0; i < kColumns * kColumns; ++i) {
    const double x = middle(domain.low[0], domain.high[0], i % kColumns, kColumns), y = middle(domain.low[1], domain.high[1], i / kColumns, kColumns);
    if (const auto z = lowest_surface(world, domain, x, y); z && *z + eye < domain.high[2]) standing.push_back({x, y, *z + eye});
    for (int k = 0; k < kLevels; ++k) floating.push_back({x, y, middle(domain.low[2], domain.high[2], k, kLevels)});
  }
  if (const auto found = best_of(world, standing, score)) return *found;
  const auto freest = best_of(world, floating, [&](const Vec<3>& p) { return world.distance(p, half); });
  return freest.value_or(center);
}

}  // namespace vantage
