// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/hausdorff.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr double kRatio = 1.1;       ///< Upper bound over truth.
constexpr double kUndecided = 1e-6;  ///< Of the limit: so near to it, the answer is no.

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

/// Half-planes of a region: the largest signed distance to their edges tells inside from outside.
template <int Rank>
struct Edges {
  using Place = typename ConvexRegion<Rank>::Place;
  std::array<Place, ConvexRegion<Rank>::kMaxVertices> normal;
  std::array<double, ConvexRegion<Rank>::kMaxVertices> offset;
  int count = 0;

  explicit Edges(const ConvexRegion<Rank>& region) {
    for (int i = 0; i < region.count; ++i)
      if (const Place n = region.edge_normal(i); n.squaredNorm() > 0.0) {
        normal[count] = n;
        offset[count++] = n.dot(region.vertices[i]);
      }
  }
  [[nodiscard]] double outside(const Place& p) const {
    double most = -kInfinity;
    for (int i = 0; i < count; ++i) most = std::max(most, normal[i].dot(p) - offset[i]);
    return most;
  }
};

/// Feet in the cells of a lattice, so that a place finds those around it.
template <int Rank>
class Lattice {
 public:
  using Place = typename ConvexRegion<Rank>::Place;
  using Number = std::array<int, Rank>;

  /// Covers the feet and [low, high], with about kPerCell feet a cell.
  Lattice(const Feet<Rank>& feet, Place low, Place high) {
    for (int k = 0; k < Rank; ++k) {
      const auto [least, most] = std::minmax_element(feet.at[k].begin(), feet.at[k].end());
      low[k] = std::min(low[k], *least);
      high[k] = std::max(high[k], *most);
    }
    const Place size = high - low;
    const double cells = static_cast<double>(feet.size()) / kPerCell;
    double spacing = size.maxCoeff() / cells;  // A row of cells at least.
    if (const double volume = size.prod(); volume > 0.0 && Rank == 2) spacing = std::max(spacing, std::sqrt(volume / cells));
    low_ = low;
    std::size_t total = 1;
    for (int k = 0; k < Rank; ++k) {
      count_[k] = spacing > 0.0 ? static_cast<int>(std::clamp(std::ceil(size[k] / spacing), 1.0, cells + 1.0)) : 1;
      width_[k] = size[k] / count_[k];
      total *= static_cast<std::size_t>(count_[k]);
    }
    start_.assign(total + 1, 0);
    std::vector<std::uint32_t> cell(feet.size());
    for (std::size_t i = 0; i < feet.size(); ++i) {
      Place p;
      for (int k = 0; k < Rank; ++k) p[k] = feet.at[k][i];
      cell[i] = static_cast<std::uint32_t>(flat(number(p)));
      ++start_[cell[i] + 1];
    }
    for (std::size_t c = 0; c < total; ++c) start_[c + 1] += start_[c];
    for (auto& axis : sorted_.at) axis.resize(feet.size());
    sorted_.height2.resize(feet.size());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const std::uint32_t to = next[cell[i]]++;
      for (int k = 0; k < Rank; ++k) sorted_.at[k][to] = feet.at[k][i];
      sorted_.height2[to] = feet.height2[i];
    }
  }

  [[nodiscard]] std::size_t size() const { return start_.size() - 1; }
  [[nodiscard]] Place half() const { return 0.5 * width_; }
  [[nodiscard]] Place center(std::size_t cell) const {
    Place p;
    for (int k = 0; k < Rank; ++k) {
      p[k] = low_[k] + (static_cast<double>(cell % static_cast<std::size_t>(count_[k])) + 0.5) * width_[k];
      cell /= static_cast<std::size_t>(count_[k]);
    }
    return p;
  }

  /// Calls `visit(squared distance, foot)` for the feet of one cell.
  template <class Visit>
  void each_in(std::size_t cell, const Place& p, Visit&& visit) const {
    for (std::size_t i = start_[cell]; i < start_[cell + 1]; ++i) {
      double sum = sorted_.height2[i];
      for (int k = 0; k < Rank; ++k) {
        const double d = sorted_.at[k][i] - p[k];
        sum += d * d;
      }
      visit(sum, i);
    }
  }
  /// For all feet in the cells that come within `reach` of p (and a few more).
  template <class Visit>
  void each_near(const Place& p, double reach, Visit&& visit) const {
    const Number first = number(p.array() - reach), last = number(p.array() + reach);
    Number at = first;
    for (;;) {
      each_in(flat(at), p, visit);
      int k = 0;
      while (k < Rank && at[k] == last[k]) {
        at[k] = first[k];
        ++k;
      }
      if (k == Rank) return;
      ++at[k];
    }
  }
  [[nodiscard]] double nearest(const Place& p) const {
    for (double reach = width_.maxCoeff();; reach *= 2.0) {
      double best2 = kInfinity;
      each_near(p, reach, [&best2](double d2, std::size_t) { best2 = std::min(best2, d2); });
      if (best2 <= reach * reach || !(reach < kInfinity)) return std::sqrt(best2);
    }
  }
  [[nodiscard]] const Feet<Rank>& feet() const { return sorted_; }

 private:
  static constexpr double kPerCell = 12.0;
  Place low_, width_;
  Number count_;
  std::vector<std::uint32_t> start_;
  Feet<Rank> sorted_;

  [[nodiscard]] Number number(const Place& p) const {
    Number n;
    for (int k = 0; k < Rank; ++k)
      n[k] = width_[k] > 0.0 ? static_cast<int>(std::clamp((p[k] - low_[k]) / width_[k], 0.0, static_cast<double>(count_[k] - 1))) : 0;
    return n;
  }
  [[nodiscard]] std::size_t flat(const Number& n) const {
    std::size_t cell = 0;
    for (int k = Rank - 1; k >= 0; --k) cell = cell * static_cast<std::size_t>(count_[k]) + static_cast<std::size_t>(n[k]);
    return cell;
  }
};

/// Branch and bound over boxes that cover the region. Each box keeps the feet that may be nearest to one of its places.
template <int Rank>
class Search {
 public:
  using Place = typename ConvexRegion<Rank>::Place;

  Search(const ConvexRegion<Rank>& region, Arena<Rank>& arena, double limit) : region_(region), edges_(region), arena_(arena), limit_(limit) {}

  /// The same from the cells of a lattice, the most promising first; the arena is empty.
  std::optional<double> run(const Lattice<Rank>& lattice) {
    for (int i = 0; i < region_.count; ++i)
      if (!raise_lower(lattice.nearest(region_.vertices[i]))) return std::nullopt;
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
      if (!raise_lower(nearest(region_.vertices[i], all))) return std::nullopt;
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
  Edges<Rank> edges_;
  Arena<Rank>& arena_;
  double limit_;
  double lower_ = 0.0, upper_ = 0.0, tiny_ = 0.0;

  /// False: the limit is passed.
  bool raise_lower(double value) {
    lower_ = std::max(lower_, value);
    return lower_ <= limit_;
  }
  [[nodiscard]] double good_enough() const { return std::min(limit_, std::max(kRatio * lower_, std::isfinite(limit_) ? 1e-6 * limit_ : 0.0)); }

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
  bool open(const Lattice<Rank>& lattice, const Place& center, const Place& half) {
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

}  // namespace

template <int Rank>
std::optional<double> covering_radius(const ConvexRegion<Rank>& region, const Feet<Rank>& points, double limit) {
  if (region.count == 0) return 0.0;
  if (points.size() == 0) return std::nullopt;
  thread_local Arena<Rank> arena;
  if (points.size() >= kManyFeet) {
    typename ConvexRegion<Rank>::Place low = region.vertices[0], high = low;
    for (int i = 1; i < region.count; ++i) {
      low = low.cwiseMin(region.vertices[i]);
      high = high.cwiseMax(region.vertices[i]);
    }
    const Lattice<Rank> lattice(points, low, high);
    arena.size = 0;
    return Search<Rank>(region, arena, limit).run(lattice);
  }
  arena.reserve(2 * points.size());
  for (int k = 0; k < Rank; ++k) std::copy(points.at[k].begin(), points.at[k].end(), arena.at[k].begin());
  std::copy(points.height2.begin(), points.height2.end(), arena.height2.begin());
  arena.size = points.size();
  return Search<Rank>(region, arena, limit).run();
}

template std::optional<double> covering_radius<1>(const ConvexRegion<1>&, const Feet<1>&, double);
template std::optional<double> covering_radius<2>(const ConvexRegion<2>&, const Feet<2>&, double);

}  // namespace vantage
