// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/disc_cover.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vantage {
namespace {

using Place = ConvexRegion<2>::Place;

constexpr double kShrink = 0.5e-6;  ///< Of the limit: discs are smaller by so much, which pays for all rounding.
constexpr double kOverlap = 1e-9;   ///< Of the limit: so deep inside a disc a corner must lie.

struct Disc {
  double x, y, radius2;
};

/// Walks along edges from disc to disc, each time with the one that reaches farthest.
class EdgeWalk {
 public:
  [[nodiscard]] std::optional<Place> gap(const Place& a, const Place& b, const std::vector<Disc>& discs, double overlap) {
    const double length = (b - a).norm();
    if (!(length > 0.0)) return std::nullopt;
    const Place along = (b - a) / length;
    chords_.clear();
    for (const Disc& disc : discs) {
      const Place to(disc.x - a[0], disc.y - a[1]);
      const double foot = to.dot(along), off = to[0] * along[1] - to[1] * along[0], half2 = disc.radius2 - off * off;
      if (half2 <= 0.0) continue;
      const double half = std::sqrt(half2);
      if (foot + half > 0.0 && foot - half < length) chords_.push_back({foot - half + overlap, foot + half});
    }
    for (double at = 0.0; at < length;) {
      double reach = at;
      for (const auto& [begin, end] : chords_)
        if (begin <= at && end > reach) reach = end;
      if (reach <= at) return a + at * along;
      at = reach;
    }
    return std::nullopt;
  }

 private:
  std::vector<std::pair<double, double>> chords_;
};

/// Where the circle of one disc crosses those near it.
class Crossings {
 public:
  Crossings(const ConvexRegion<2>& region, double limit) : edges_(region), deep_(2.0 * kOverlap * limit * limit), far2_(4.0 * limit * limit) {}

  /// Crossings with discs after number `i` only; each pair is asked once.
  [[nodiscard]] std::optional<Place> gap(const std::vector<Disc>& discs, std::size_t i) {
    const Disc disc = discs[i];
    near_.clear();
    std::size_t first_after = 0;
    for (std::size_t j = 0; j < discs.size(); ++j) {
      const double dx = discs[j].x - disc.x, dy = discs[j].y - disc.y;
      if (j == i) first_after = near_.size();
      if (j != i && dx * dx + dy * dy < far2_) near_.push_back({dx, dy, discs[j].radius2});
    }
    for (std::size_t j = first_after; j < near_.size(); ++j) {
      const double dx = near_[j].x, dy = near_[j].y, apart2 = dx * dx + dy * dy;
      const double along = 0.5 * (disc.radius2 - near_[j].radius2 + apart2);  // Times the distance between the centres.
      const double across2 = disc.radius2 * apart2 - along * along;
      if (across2 <= 0.0) continue;
      const double u = along / apart2, v = std::sqrt(across2) / apart2;
      for (const double side : {v, -v}) {
        const double x = u * dx - side * dy, y = u * dy + side * dx;
        if (holds(x, y)) continue;
        const Place p(disc.x + x, disc.y + y);
        if (edges_.outside(p) <= 0.0) return p;
      }
    }
    return std::nullopt;
  }

 private:
  RegionEdges<2> edges_;
  double deep_, far2_;
  std::vector<Disc> near_;  ///< From the disc's centre.
  std::size_t last_ = 0;    ///< The disc that held the last place: corners are near each other.

  [[nodiscard]] bool holds(double x, double y) {
    const auto deep_in = [&](const Disc& disc) { return (disc.x - x) * (disc.x - x) + (disc.y - y) * (disc.y - y) < disc.radius2 - deep_; };
    if (last_ < near_.size() && deep_in(near_[last_])) return true;
    for (std::size_t k = 0; k < near_.size(); ++k)
      if (deep_in(near_[k])) {
        last_ = k;
        return true;
      }
    return false;
  }
};

}  // namespace

std::optional<Place> find_uncovered(const ConvexRegion<2>& region, const Feet<2>& points, double limit) {
  thread_local std::vector<Disc> discs;
  thread_local EdgeWalk walk;
  discs.clear();
  const double serves = limit * (1.0 - kShrink);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const double radius2 = serves * serves - points.height2[i]; radius2 > 0.0) discs.push_back({points.at[0][i], points.at[1][i], radius2});
  const auto holds_all = [&](const Disc& d) {
    for (int i = 0; i < region.count; ++i)
      if ((region.vertices[i] - Place(d.x, d.y)).squaredNorm() > d.radius2) return false;
    return true;
  };
  if (std::any_of(discs.begin(), discs.end(), holds_all)) return std::nullopt;
  for (int i = 0; i < region.count; ++i) {
    const Place& p = region.vertices[i];
    const auto holds = [&](const Disc& d) {
      return (d.x - p[0]) * (d.x - p[0]) + (d.y - p[1]) * (d.y - p[1]) < d.radius2 - 2.0 * kOverlap * limit * limit;
    };
    if (std::none_of(discs.begin(), discs.end(), holds)) return p;
  }
  for (int i = 0; i < region.count; ++i)
    if (const auto place = walk.gap(region.vertices[i], region.vertices[(i + 1) % region.count], discs, kOverlap * limit)) return place;
  Crossings crossings(region, limit);
  for (std::size_t i = 0; i + 1 < discs.size(); ++i)
    if (const auto place = crossings.gap(discs, i)) return place;
  return std::nullopt;
}

}  // namespace vantage
