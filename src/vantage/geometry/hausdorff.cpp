// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/hausdorff.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr double kRatio = 1.1;       ///< Upper bound over truth.
constexpr double kUndecided = 1e-6;  ///< Of the limit: so near to it, the answer is no.

/// Branch and bound over boxes that cover the region. Each box keeps the points that may be nearest to one of its places.
template <int Rank>
class Search {
 public:
  using Place = typename ConvexRegion<Rank>::Place;

  Search(const ConvexRegion<Rank>& region, Feet<Rank>& arena, double limit) : region_(region), arena_(arena), limit_(limit) {}

  /// The arena holds the points, and only them.
  std::optional<double> run() {
    const Points all{0, arena_.size()};
    Place low = region_.vertices[0], high = low;
    for (int i = 0; i < region_.count; ++i) {
      low = low.cwiseMin(region_.vertices[i]);
      high = high.cwiseMax(region_.vertices[i]);
      if (!raise_lower(nearest(region_.vertices[i], all))) return std::nullopt;
    }
    Item root{0.5 * (low + high), 0.5 * (high - low), all, 0.0, true};
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
  };

  const ConvexRegion<Rank>& region_;
  Feet<Rank>& arena_;
  double limit_;
  double lower_ = 0.0, upper_ = 0.0, tiny_ = 0.0;

  /// False: the limit is passed.
  bool raise_lower(double value) {
    lower_ = std::max(lower_, value);
    return lower_ <= limit_;
  }
  [[nodiscard]] double good_enough() const { return std::min(limit_, std::max(kRatio * lower_, std::isfinite(limit_) ? 1e-6 * limit_ : 0.0)); }

  double distance2(std::size_t i, const Place& p) const {
    double sum = arena_.height2[i];
    for (int k = 0; k < Rank; ++k) {
      const double d = arena_.at[k][i] - p[k];
      sum += d * d;
    }
    return sum;
  }
  double nearest(const Place& p, Points points) const {
    double best = kInfinity;
    for (std::size_t i = points.begin; i < points.end; ++i) best = std::min(best, distance2(i, p));
    return std::sqrt(best);
  }

  /// Bounds of a box; keeps its points at the end of the arena. nullopt: the limit is passed.
  std::optional<Item> evaluate(const Place& center, const Place& half, const Item& parent) {
    const Points parents = parent.points;
    const double radius = half.norm();
    Item item{center, half, {arena_.size(), arena_.size()}, 0.0, false};
    const Place inside = region_.closest(center);
    const double apart = (inside - center).norm();
    if (apart > radius) return item;  // The box misses the region.
    double best2 = kInfinity;
    std::size_t best = parents.begin;
    for (std::size_t i = parents.begin; i < parents.end; ++i) {
      const double d2 = distance2(i, center);
      if (d2 < best2) {
        best2 = d2;
        best = i;
      }
    }
    const double distance = std::sqrt(best2);
    if (!raise_lower(distance - apart)) return std::nullopt;
    // The parent's points serve places within its circle only.
    const bool served = (inside - parent.center).squaredNorm() <= parent.half.squaredNorm();
    if (apart > 0.0 && served && distance + apart > lower_ && !raise_lower(nearest(inside, parents))) return std::nullopt;
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
    for (std::size_t i = parents.begin; i < parents.end; ++i) {
      if (distance2(i, center) > keep * keep) continue;
      for (auto& axis : arena_.at) axis.push_back(double(axis[i]));
      arena_.height2.push_back(double(arena_.height2[i]));
    }
    item.points.end = arena_.size();
    return item;
  }

  bool visit(const Item& item) {
    if (item.half.norm() <= tiny_) {  // As exact as doubles are.
      upper_ = std::max(upper_, item.upper);
      return item.upper <= limit_;
    }
    const std::size_t mark = arena_.size();
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
    resize(mark);
    return true;
  }

  void resize(std::size_t size) {
    for (auto& axis : arena_.at) axis.resize(size);
    arena_.height2.resize(size);
  }
};

}  // namespace

template <int Rank>
std::optional<double> covering_radius(const ConvexRegion<Rank>& region, const Feet<Rank>& points, double limit) {
  if (region.count == 0) return 0.0;
  if (points.size() == 0) return std::nullopt;
  thread_local Feet<Rank> arena;
  arena = points;
  return Search<Rank>(region, arena, limit).run();
}

template std::optional<double> covering_radius<1>(const ConvexRegion<1>&, const Feet<1>&, double);
template std::optional<double> covering_radius<2>(const ConvexRegion<2>&, const Feet<2>&, double);

}  // namespace vantage
