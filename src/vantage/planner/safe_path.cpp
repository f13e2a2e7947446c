// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/safe_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace vantage {
namespace {

constexpr std::array<std::uint32_t, 4> kCost{0, 70, 99, 121};  // Of a step along so many axes: 70 sqrt(n).
constexpr std::uint32_t kBuckets = 256;                        // More than a step can add to length plus distance left.

/// Steps to the neighbours of a node; number 3^Dim / 2 stays.
template <int Dim>
struct Steps {
  static constexpr int kCount = 9 + 18 * (Dim - 2);  // 3^Dim

  explicit Steps(const Grid<Dim>& grid) {
    for (int n = 0; n < kCount; ++n) {
      Index<Dim> step;
      for (int a = 0, rest = n; a < Dim; ++a, rest /= 3) step[a] = rest % 3 - 1;
      const auto k = static_cast<std::size_t>(n);
      cost[k] = kCost[static_cast<std::size_t>(step.squaredNorm())];
      for (int a = 0; a < Dim; ++a) offset[k] += static_cast<std::ptrdiff_t>(grid.stride(a)) * step[a];
      for (int corner = 1; corner < (1 << Dim); ++corner) {
        int between = 0;
        for (int a = Dim - 1; a >= 0; --a) between = between * 3 + 1 + ((corner >> a & 1) != 0 ? step[a] : 0);
        needs[k] |= 1U << between;
      }
    }
  }
  std::array<std::ptrdiff_t, kCount> offset{};
  std::array<std::uint32_t, kCount> cost{}, needs{};  // needs: bits of the nodes that a step passes between, its end among them.
};

/// A* from one node to another.
template <int Dim>
class Search {
 public:
  explicit Search(const Field<Dim, std::uint8_t>& reachable) : reachable_(reachable), grid_(reachable.window), steps_(grid_) {}

  /// Nodes on the way, both ends among them; only `to` if there is none.
  std::vector<std::size_t> run(std::size_t from, std::size_t to) {
    came_by_ = Field<Dim, std::uint8_t>(grid_);
    length_ = std::make_unique_for_overwrite<std::uint32_t[]>(grid_.size());
    goal_ = grid_.local(to);
    reach(from, 0, Steps<Dim>::kCount / 2);
    for (std::uint32_t f = left(grid_.local(from)); waiting_ > 0; ++f) {
      auto& bucket = buckets_[f % kBuckets];
      while (!bucket.empty()) {
        const auto [node, length] = bucket.back();
        bucket.pop_back();
        --waiting_;
        if (node == to) return trace(from, to);
        if (length == length_[node]) expand(node, length);
      }
    }
    return {to};
  }

 private:
  /// Length left at least: sqrt(n) steps along the diagonals, the rest straight.
  [[nodiscard]] std::uint32_t left(const Index<Dim>& node) const {
    std::array<std::int32_t, Dim> gap;
    for (std::size_t a = 0; a < Dim; ++a) gap[a] = std::abs(goal_[static_cast<int>(a)] - node[static_cast<int>(a)]);
    std::sort(gap.begin(), gap.end(), std::greater<>());
    std::uint32_t sum = 0;
    for (std::size_t a = 0; a < Dim; ++a) sum += static_cast<std::uint32_t>(gap[a]) * (kCost[a + 1] - kCost[a]);
    return sum;
  }
  void reach(std::size_t node, std::uint32_t length, int step) {
    if (came_by_[node] != 0 && length_[node] <= length) return;
    came_by_[node] = static_cast<std::uint8_t>(step + 1);
    length_[node] = length;
    buckets_[(length + left(grid_.local(node))) % kBuckets].emplace_back(node, length);
    ++waiting_;
  }
  void expand(std::size_t node, std::uint32_t length) {
    const Index<Dim> here = grid_.local(node);
    const bool inner = (here.array() > 0).all() && (here.array() + 1 < grid_.extent.array()).all();
    std::uint32_t open = 0;
    for (int n = 0; n < Steps<Dim>::kCount; ++n) {
      if (!inner) {
        Index<Dim> other = here;
        for (int a = 0, rest = n; a < Dim; ++a, rest /= 3) other[a] += rest % 3 - 1;
        if (!grid_.inside(other)) continue;
      }
      open |= static_cast<std::uint32_t>(reachable_[next(node, n)] != 0) << n;
    }
    for (int n = 0; n < Steps<Dim>::kCount; ++n)
      if ((open & steps_.needs[static_cast<std::size_t>(n)]) == steps_.needs[static_cast<std::size_t>(n)])
        reach(next(node, n), length + steps_.cost[static_cast<std::size_t>(n)], n);
  }
  [[nodiscard]] std::size_t next(std::size_t node, int step) const {
    return node + static_cast<std::size_t>(steps_.offset[static_cast<std::size_t>(step)]);
  }
  std::vector<std::size_t> trace(std::size_t from, std::size_t to) const {
    std::vector<std::size_t> way{to};
    while (way.back() != from)
      way.push_back(way.back() - static_cast<std::size_t>(steps_.offset[static_cast<std::size_t>(came_by_[way.back()] - 1)]));
    std::reverse(way.begin(), way.end());
    return way;
  }

  const Field<Dim, std::uint8_t>& reachable_;
  Grid<Dim> grid_;
  Steps<Dim> steps_;
  Index<Dim> goal_;
  Field<Dim, std::uint8_t> came_by_;  // Number of the step, plus 1; 0: not reached.
  std::unique_ptr<std::uint32_t[]> length_;
  std::array<std::vector<std::pair<std::size_t, std::uint32_t>>, kBuckets> buckets_;  // By length plus what is left, modulo.
  std::size_t waiting_ = 0;
};

/// True if every cell that the straight line between two nodes touches is reachable; a node's cell is the cube around it. Exact: in cells, times the
/// steps along an axis, all places where the line goes from one cell to the next are odd numbers over twice a step count.
template <int Dim>
bool clear_line(const Field<Dim, std::uint8_t>& reachable, std::size_t from, std::size_t to) {
  const Grid<Dim>& grid = reachable.window;
  Index<Dim> cell = grid.local(from);
  const Index<Dim> end = grid.local(to), sign = (end - cell).cwiseSign();
  std::array<std::int64_t, Dim> steps, done{};  // Along each axis.
  for (std::size_t a = 0; a < Dim; ++a) steps[a] = std::abs(end[static_cast<int>(a)] - cell[static_cast<int>(a)]);
  if (reachable.at(cell) == 0) return false;
  while (cell != end) {
    // The axes whose next border is met first: border k of n is at (2 k + 1) / (2 n) of the way.
    int first = -1;
    unsigned axes = 0;
    for (std::size_t a = 0; a < Dim; ++a) {
      if (done[a] == steps[a]) continue;
      const auto f = static_cast<std::size_t>(first);
      const std::int64_t later = first < 0 ? -1 : (2 * done[a] + 1) * steps[f] - (2 * done[f] + 1) * steps[a];
      if (later < 0) first = static_cast<int>(a), axes = 0;
      if (later <= 0) axes |= 1U << a;
    }
    for (unsigned some = axes; some != 0; some = (some - 1) & axes) {  // Through an edge or a corner all cells around it are touched.
      Index<Dim> touched = cell;
      for (int a = 0; a < Dim; ++a) touched[a] += (some >> a & 1U) != 0 ? sign[a] : 0;
      if (reachable.at(touched) == 0) return false;
    }
    for (std::size_t a = 0; a < Dim; ++a) {
      if ((axes >> a & 1U) == 0) continue;
      cell[static_cast<int>(a)] += sign[static_cast<int>(a)];
      ++done[a];
    }
  }
  return true;
}

/// Leaves out nodes between which the line is clear: from each on to the farthest that doubling and halving the stride find.
template <int Dim>
std::vector<std::size_t> pull_taut(const Field<Dim, std::uint8_t>& reachable, const std::vector<std::size_t>& way) {
  std::vector<std::size_t> taut{way.front()};
  for (std::size_t at = 0; at + 1 < way.size();) {
    std::size_t good = 1, stride = 2;
    while (at + stride < way.size() && clear_line(reachable, way[at], way[at + stride])) {
      good = stride;
      stride *= 2;
    }
    for (; stride > 0; stride /= 2)
      if (at + good + stride < way.size() && clear_line(reachable, way[at], way[at + good + stride])) good += stride;
    at += good;
    taut.push_back(way[at]);
  }
  return taut;
}

}  // namespace

template <int Dim>
std::vector<Vec<Dim>> safe_path(const Field<Dim, std::uint8_t>& reachable, std::size_t first, std::size_t target, const Vec<Dim>& here) {
  const Grid<Dim>& grid = reachable.window;
  std::vector<std::size_t> way{first, target};
  if (!clear_line(reachable, first, target)) way = pull_taut(reachable, Search<Dim>(reachable).run(first, target));
  std::vector<Vec<Dim>> path{here};
  for (std::size_t i = first == target ? 1 : 0; i < way.size(); ++i) path.push_back(grid.position(way[i]));
  return path;
}

template std::vector<Vec<2>> safe_path<2>(const Field<2, std::uint8_t>&, std::size_t, std::size_t, const Vec<2>&);
template std::vector<Vec<3>> safe_path<3>(const Field<3, std::uint8_t>&, std::size_t, std::size_t, const Vec<3>&);

}  // namespace vantage
