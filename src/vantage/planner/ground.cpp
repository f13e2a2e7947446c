// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/ground.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kFarthest = 6.0;  // Ground that far from the scanner may still be its own [m].
constexpr double kAround = 1.0;    // A table or a kerb beside the scanner is less of the ground around it [m].
constexpr double kUpright = 4.0;   // How high the scanner stands is known better than what is free right below: so much more heights count.

/// A place to stand, in one column of the lattice.
struct Floor {
  std::int32_t level = 0;  ///< Of the lowest seen node above it.
  double ground = 0.0;     ///< Height [m].
  bool reached = false;
};

/// Height of the ground right below a seen node [m].
template <int Dim>
double ground_at(const BeliefView<Dim>& view, std::size_t above) {
  const double gap = std::min(static_cast<double>(view.known_distance[above]), 2.0 * view.window().spacing);
  return view.window().position(above)[Dim - 1] - gap;
}

/// All floors of all columns.
template <int Dim>
class Floors {
 public:
  explicit Floors(const BeliefView<Dim>& view) : view_(view), grid_(view.window()) {
    columns_ = grid_.size() / static_cast<std::size_t>(levels());
    floors_.resize(columns_);
    parallel_for(columns_, 64, [&](std::size_t c) { find(c); });
  }

  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::int32_t levels() const { return grid_.extent[kUp]; }
  [[nodiscard]] std::vector<Floor>& column(std::size_t c) { return floors_[c]; }
  [[nodiscard]] std::size_t node(std::size_t column, std::int32_t level) const { return column + static_cast<std::size_t>(level) * columns_; }
  [[nodiscard]] Vec<Dim> foot(std::size_t column, const Floor& floor) const {
    Vec<Dim> p = grid_.position(column);
    p[kUp] = floor.ground;
    return p;
  }
  /// Keeps the floors that a scanner can stand on.
  void keep_free(const GroundOptions& options, const std::function<bool(const Vec<Dim>&)>& closed) {
    parallel_for(columns_, 64, [&](std::size_t c) {
      std::erase_if(floors_[c], [&](const Floor& f) { return !is_free(c, f, options) || (closed && is_closed(c, f, options.height, closed)); });
    });
  }
  /// Levels next to where the scanner stands on a floor: within a cell.
  template <class Use>
  void for_levels(const Floor& floor, double height, Use&& use) const {
    const double level = (floor.ground + height) / grid_.spacing - grid_.first[kUp];
    for (auto k = static_cast<std::int32_t>(std::floor(level)); k <= static_cast<std::int32_t>(std::ceil(level)); ++k)
      if (k >= floor.level && k < levels()) use(k);
  }
  /// Marks what can be walked to.
  void flood(std::size_t column, std::size_t first, const GroundOptions& options) {
    const double rise = std::max(options.step, options.slope * grid_.spacing);
    std::vector<std::pair<std::size_t, std::size_t>> queue{{column, first}};
    floors_[column][first].reached = true;
    for (std::size_t k = 0; k < queue.size(); ++k) {
      const auto [c, f] = queue[k];
      const Index<Dim> here = grid_.local(c);
      for (int side = 0; side < 2 * kUp; ++side) {
        Index<Dim> next = here;
        next[side / 2] += side % 2 == 0 ? -1 : 1;
        if (!grid_.inside(next)) continue;
        const std::size_t other = grid_.linear(next);
        for (std::size_t i = 0; i < floors_[other].size(); ++i) {
          Floor& floor = floors_[other][i];
          if (floor.reached || std::abs(floor.ground - floors_[c][f].ground) > rise) continue;
          floor.reached = true;
          queue.emplace_back(other, i);
        }
      }
    }
  }

  /// Of a place: the median of the columns right around it or, if none has a floor, of those within `reach`.
  [[nodiscard]] double height_of(const Vec<Dim>& place, double reach) const {
    const double near = std::max(kAround, 2.0 * grid_.spacing);
    std::vector<double> around, all;
    for (std::size_t c = 0; c < columns_; ++c) {
      double least = kInfinity;  // The uppermost floor below the scanner counts.
      Vec<Dim> foot = grid_.position(c);
      foot[kUp] = place[kUp];
      const double away = (foot - place).norm();
      if (away > std::max(near, reach)) continue;
      for (const Floor& floor : floors_[c])
        if (floor.ground < place[kUp]) least = std::min(least, place[kUp] - floor.ground);
      if (!(least < kInfinity)) continue;
      all.push_back(least);
      if (away <= near) around.push_back(least);
    }
    std::vector<double>& heights = around.empty() ? all : around;
    if (heights.empty()) return kInfinity;
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2), heights.end());
    return heights[heights.size() / 2];
  }

 private:
  static constexpr int kUp = Dim - 1;

  void find(std::size_t c) {
    for (std::int32_t k = 0; k + 1 < levels(); ++k)
      if (view_.state[node(c, k)] == NodeState::obstacle && view_.seen(node(c, k + 1)))
        floors_[c].push_back({k + 1, ground_at(view_, node(c, k + 1))});
  }
  [[nodiscard]] bool is_free(std::size_t c, const Floor& floor, const GroundOptions& options) const {
    const double clearance = std::min(options.clearance, 0.9 * options.height);
    bool any = false, clear = true;
    std::int32_t top = floor.level;
    for_levels(floor, options.height, [&](std::int32_t k) {
      any = true;
      top = std::max(top, k);
      clear = clear && static_cast<double>(view_.known_distance[node(c, k)]) >= clearance - 0.5 * grid_.spacing;
    });
    for (std::int32_t k = floor.level; clear && k <= top; ++k) clear = view_.seen(node(c, k));
    return any && clear;
  }

  [[nodiscard]] bool is_closed(std::size_t c, const Floor& floor, double height, const std::function<bool(const Vec<Dim>&)>& closed) const {
    bool any = false;
    for_levels(floor, height, [&](std::int32_t k) { any = any || closed(grid_.position(node(c, k))); });
    return any;
  }

  const BeliefView<Dim>& view_;
  Grid<Dim> grid_;
  std::size_t columns_ = 0;
  std::vector<std::vector<Floor>> floors_;
};

}  // namespace

template <int Dim>
Field<Dim, std::uint8_t> walkable_nodes(const BeliefView<Dim>& view, const Vec<Dim>& from, const GroundOptions& options,
                                        const std::function<bool(const Vec<Dim>&)>& closed) {
  Field<Dim, std::uint8_t> nodes(view.window());
  Floors<Dim> floors(view);
  floors.keep_free(options, closed);
  const Vec<Dim> below = from - options.height * Vec<Dim>::Unit(Dim - 1);
  double nearest = std::max(kFarthest, 2.0 * options.height);
  std::size_t column = floors.columns(), first = 0;
  for (std::size_t c = 0; c < floors.columns(); ++c)
    for (std::size_t f = 0; f < floors.column(c).size(); ++f) {
      Vec<Dim> offset = floors.foot(c, floors.column(c)[f]) - below;
      offset[Dim - 1] *= kUpright;
      const double distance = offset.norm();
      if (distance >= nearest) continue;
      nearest = distance;
      column = c;
      first = f;
    }
  if (column == floors.columns()) return nodes;
  floors.flood(column, first, options);
  for (std::size_t c = 0; c < floors.columns(); ++c)
    for (const Floor& floor : floors.column(c))
      if (floor.reached) floors.for_levels(floor, options.height, [&](std::int32_t k) { nodes[floors.node(c, k)] = 1; });
  return nodes;
}

template <int Dim>
std::vector<double> heights_above_ground(const BeliefView<Dim>& view, std::span<const Vec<Dim>> places, double reach) {
  Floors<Dim> floors(view);
  std::vector<double> heights;
  for (const Vec<Dim>& place : places) heights.push_back(floors.height_of(place, reach));
  return heights;
}

template <int Dim>
double ground_below(const BeliefView<Dim>& view, const Vec<Dim>& place) {
  const Grid<Dim>& grid = view.window();
  Index<Dim> node = grid.nearest(place);
  if (!grid.inside(node) || !view.seen(grid.linear(node))) return -kInfinity;
  while (node[Dim - 1] > 0) {
    const std::size_t above = grid.linear(node);
    --node[Dim - 1];
    if (view.state.at(node) == NodeState::obstacle) return ground_at(view, above);
    if (!view.seen(grid.linear(node))) return -kInfinity;
  }
  return -kInfinity;
}

#define VANTAGE_INSTANTIATE(D)                                                                                 \
  template Field<D, std::uint8_t> walkable_nodes<D>(const BeliefView<D>&, const Vec<D>&, const GroundOptions&, \
                                                    const std::function<bool(const Vec<D>&)>&);                \
  template std::vector<double> heights_above_ground<D>(const BeliefView<D>&, std::span<const Vec<D>>, double); \
  template double ground_below<D>(const BeliefView<D>&, const Vec<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
