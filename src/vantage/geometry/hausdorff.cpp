// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/hausdorff.h"

#include <algorithm>
#include <cmath>

#include "vantage/geometry/disc_cover.h"
#include "vantage/geometry/feet_lattice.h"

namespace vantage {
namespace {

constexpr double kRatio = 1.1;       ///< Upper bound over truth.
constexpr double kUndecided = 1e-6;  ///< Of the limit: so near to it, the answer is no.

/// For so many feet, discs are the fastest way to decide.
constexpr std::size_t kFewFeet = 64;
/// So many feet are sorted into a lattice first.
constexpr std::size_t kManyFeet = 256;

/// Stack of feet; the search works at its top.
template <int Rank>
struct Arena {
  std::array<std::vector<double>, Rank> at;
  std::vector<double> height2;
  std::vector<double> distance2;  ///< Of the feet last looked at.
  std::size_t size = 0;

  void reserve(std::size_t capacity) {
    if (capacity <= height2.size()) return;
    capacity += capacity / 2;
    for (auto& axis : at) axis.resize(capacity);
    height2.resize(capacity);
    distance2.resize(capacity);
  }
};

/// Branch and bound over boxes that cover the region. Each box keeps the feet that may be nearest to one of its places.
template <int Rank>
class Search {
 public:
  using Place = typename ConvexRegion<Rank>::Place;

  Search(const ConvexRegion<Rank>& region, Arena<Rank>& arena, double limit, double enough)
      : region_(region), edges_(region), arena_(arena), limit_(limit), enough_(std::isfinite(limit) ? std::max(enough, 1e-6) * limit : 0.0) {}

  /// A place farther away than the limit, once a search has found one.
  [[nodiscard]] const Place& farthest() const { return farthest_; }

  /// The same from the cells of a lattice, the most promising first; the arena is empty.
  std::optional<double> run(const FeetLattice<Rank>& lattice) {
    for (int i = 0; i < region_.count; ++i)
      if (!raise_lower(lattice.nearest(region_.vertices[i]), region_.vertices[i])) return std::nullopt;
    const Place half = lattice.half();
    const double radius = half.norm();
    tiny_ = std::isfinite(limit_) ? kUndecided / 2.0 * limit_ : 1e-10 * radius;
    std::vector<std::pair<double, std::size_t>> order;  // Upper bounds from the cells' own feet.
    for (std::size_t cell = 0; cell < lattice.size(); ++cell) {
      const Place center = lattice.center(cell);
      if (edges_.outside(center) > radius) continue;
      double best2 = kInfinity;
      lattice.each_in(cell, center, [&best2](double d2, std::size_t) { best2 = std::min(best2, d2); });
      order.emplace_back(std::sqrt(best2) + radius, cell);
    }
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
    for (const auto& [upper, cell] : order) {
      if (upper <= good_enough()) return std::max({lower_, upper_, upper});  // So are all that follow.
      if (!open(lattice, lattice.center(cell), half)) return std::nullopt;
    }
    return std::max(lower_, upper_);
  }

  /// The arena holds the points, and only them.
  std::optional<double> run() {
    const Points all{0, arena_.size};
    Place low = region_.vertices[0], high = low;
    for (int i = 0; i < region_.count; ++i) {
      low = low.cwiseMin(region_.vertices[i]);
      high = high.cwiseMax(region_.vertices[i]);
      if (!raise_lower(nearest(region_.vertices[i], all), region_.vertices[i])) return std::nullopt;
    }
    Item root{0.5 * (low + high), 0.5 * (high - low), all, 0.0, true, false};
    root.upper = root.half.norm() + nearest(root.center, all);
    tiny_ = std::isfinite(limit_) ? kUndecided / 2.0 * limit_ : 1e-10 * root.upper;
    if (!visit(root)) return std::nullopt;
    return std::max(lower_, upper_);
  }

 private:
  struct Points {
    std::size_t begin, end;
  };
  struct Item {
    Place center, half;
    Points points;
    double upper;  ///< No place of region and box is farther from the points.
    bool open;     ///< Needs a closer look.
    bool within;   ///< Lies in the region whole.
  };

  const ConvexRegion<Rank>& region_;
  RegionEdges<Rank> edges_;
  Arena<Rank>& arena_;
  double limit_;
  double enough_;
  Place farthest_ = Place::Zero();
  double lower_ = 0.0, upper_ = 0.0, tiny_ = 0.0;

  /// False: the limit is passed.
  bool raise_lower(double value, const Place& place) {
    if (value <= lower_) return true;
    lower_ = value;
    farthest_ = place;
    return lower_ <= limit_;
  }
  [[nodiscard]] double good_enough() const { return std::min(limit_, std::max(kRatio * lower_, enough_)); }

  [[nodiscard]] double distance2(std::size_t i, const Place& p) const {
    double sum = arena_.height2[i];
    for (int k = 0; k < Rank; ++k) {
      const double d = arena_.at[k][i] - p[k];
      sum += d * d;
    }
    return sum;
  }
  [[nodiscard]] double nearest(const Place& p, Points points) const {
    double best = kInfinity;
    for (std::size_t i = points.begin; i < points.end; ++i) best = std::min(best, distance2(i, p));
    return std::sqrt(best);
  }

  /// Searches one cell of a lattice.
  bool open(const FeetLattice<Rank>& lattice, const Place& center, const Place& half) {
    const double keep = lattice.nearest(center) + 2.0 * half.norm();
    arena_.size = 0;
    lattice.each_near(center, keep, [&](double d2, std::size_t i) {
      if (d2 > keep * keep) return;
      arena_.reserve(arena_.size + 1);
      for (int k = 0; k < Rank; ++k) arena_.at[k][arena_.size] = lattice.feet().at[k][i];
      arena_.height2[arena_.size++] = lattice.feet().height2[i];
    });
    const Item parent{center, half, {0, arena_.size}, kInfinity, true, false};
    const auto item = evaluate(center, half, parent);
    return item && (!item->open || visit(*item));
  }

  /// A box's part that needs a closer look keeps its points at the top of the arena. nullopt: the limit is passed.
  std::optional<Item> evaluate(const Place& center, const Place& half, const Item& parent) {
    const Points parents = parent.points;
    const double radius = half.norm();
    Item item{center, half, {arena_.size, arena_.size}, 0.0, false, parent.within};
    double apart = 0.0;  // To the region.
    Place inside = center;
    if (!parent.within) {
      const double outside = edges_.outside(center);
      if (outside > radius) return item;  // The box misses the region.
      item.within = outside <= -radius;
      if (outside > 0.0) {
        inside = region_.closest(center);
        apart = (inside - center).norm();
        if (apart > radius) return item;
      }
    }
    arena_.reserve(arena_.size + (parents.end - parents.begin));
    double best2 = kInfinity;
    std::size_t best = parents.begin;
    for (std::size_t i = parents.begin; i < parents.end; ++i) {
      const double d2 = distance2(i, center);
      arena_.distance2[i] = d2;
      if (d2 < best2) {
        best2 = d2;
        best = i;
      }
    }
    const double distance = std::sqrt(best2);
    if (!raise_lower(distance - apart, inside)) return std::nullopt;
    // The parent's points serve places within its circle only.
    const bool served = (inside - parent.center).squaredNorm() <= parent.half.squaredNorm();
    if (apart > 0.0 && served && distance + apart > lower_ && !raise_lower(nearest(inside, parents), inside)) return std::nullopt;
    double corner2 = arena_.height2[best];  // The nearest point to the box's farthest corner.
    for (int k = 0; k < Rank; ++k) {
      const double d = std::abs(arena_.at[k][best] - center[k]) + half[k];
      corner2 += d * d;
    }
    item.upper = std::sqrt(corner2);
    if (item.upper <= good_enough()) {
      upper_ = std::max(upper_, item.upper);
      return item;
    }
    item.open = true;
    const double keep = distance + 2.0 * radius;
    std::size_t end = arena_.size;
    for (std::size_t i = parents.begin; i < parents.end; ++i) {
      for (int k = 0; k < Rank; ++k) arena_.at[k][end] = arena_.at[k][i];
      arena_.height2[end] = arena_.height2[i];
      end += arena_.distance2[i] <= keep * keep ? 1 : 0;
    }
    arena_.size = item.points.end = end;
    return item;
  }

  bool visit(const Item& item) {
    if (item.half.norm() <= tiny_) {  // As exact as doubles are.
      upper_ = std::max(upper_, item.upper);
      return item.upper <= limit_;
    }
    const std::size_t mark = arena_.size;
    Eigen::Index axis = 0;
    item.half.maxCoeff(&axis);
    Place half = item.half;
    half[axis] *= 0.5;
    std::array<Item, 2> parts;
    for (int side = 0; side < 2; ++side) {
      Place center = item.center;
      center[axis] += side == 0 ? -half[axis] : half[axis];
      const auto part = evaluate(center, half, item);
      if (!part) return false;
      parts[side] = *part;
    }
    if (parts[1].upper > parts[0].upper) std::swap(parts[0], parts[1]);
    for (const Item& part : parts) {
      if (!part.open) continue;
      if (part.upper <= good_enough()) {  // The lower bound has risen since.
        upper_ = std::max(upper_, part.upper);
      } else if (!visit(part)) {
        return false;
      }
    }
    arena_.size = mark;
    return true;
  }
};

/// Is the place in the region, and farther than the limit from all points?
bool passes_limit(const ConvexRegion<2>& region, const Feet<2>& points, double limit, const ConvexRegion<2>::Place& p) {
  if (RegionEdges<2>(region).outside(p) > 0.0) return false;
  double best2 = kInfinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double dx = points.at[0][i] - p[0], dy = points.at[1][i] - p[1];
    best2 = std::min(best2, dx * dx + dy * dy + points.height2[i]);
  }
  return best2 > limit * limit;
}

CoverRadius<2> branch_and_bound(const ConvexRegion<2>& region, const Feet<2>& points, double limit, double enough) {
  constexpr int Rank = 2;
  thread_local Arena<Rank> arena;
  Search<Rank> search(region, arena, limit, enough);
  std::optional<double> radius;
  if (points.size() >= kManyFeet) {
    ConvexRegion<Rank>::Place low = region.vertices[0], high = low;
    for (int i = 1; i < region.count; ++i) {
      low = low.cwiseMin(region.vertices[i]);
      high = high.cwiseMax(region.vertices[i]);
    }
    arena.size = 0;
    radius = search.run(FeetLattice<Rank>(points, low, high));
  } else {
    arena.reserve(2 * points.size());
    for (int k = 0; k < Rank; ++k) std::copy(points.at[k].begin(), points.at[k].end(), arena.at[k].begin());
    std::copy(points.height2.begin(), points.height2.end(), arena.height2.begin());
    arena.size = points.size();
    radius = search.run();
  }
  return {radius, search.farthest()};
}

}  // namespace

template <>
CoverRadius<2> cover(const ConvexRegion<2>& region, const Feet<2>& points, double limit, const CoverSearch<2>& search) {
  constexpr double kWider = 1.0 + 1e-3;
  constexpr double kRoom = 0.8;  // Bounds of many feet leave so much, that they outlast updates.
  constexpr std::size_t kRoomFeet = 256;
  if (region.count == 0) return {0.0, {}};
  if (points.size() == 0) return {std::nullopt, region.vertices[0]};
  if (!std::isfinite(limit)) return branch_and_bound(region, points, limit, 0.0);
  // All searches decide alike; then one that wants more looks for the radius without that limit in its way.
  if (search.first != nullptr && passes_limit(region, points, limit, *search.first)) return {std::nullopt, *search.first};
  CoverRadius<2> covering{limit, {}};
  if (points.size() > kFewFeet) {
    covering = branch_and_bound(region, points, limit, points.size() >= kRoomFeet ? kRoom : 1.0);
  } else if (const auto uncovered = find_uncovered(region, points, limit)) {
    covering = {std::nullopt, *uncovered};
  }
  if (!covering.radius || *covering.radius <= search.enough * limit) return covering;
  const double radius = branch_and_bound(region, points, kWider * limit, search.enough).radius.value_or(limit);
  return {std::min(limit, radius), {}};
}

}  // namespace vantage
