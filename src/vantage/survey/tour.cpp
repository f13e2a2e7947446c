// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/tour.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kFrontNodes = 4e7;  // Of all fronts together: about half a minute of one core.
constexpr double kGain = 1e-9;       // Least shortening [m].

/// Every `factor`-th node.
template <int Dim>
Field<Dim, std::uint8_t> thinned(const Field<Dim, std::uint8_t>& passable, int factor) {
  const Grid<Dim>& fine = passable.window;
  Field<Dim, std::uint8_t> coarse(window_over(fine.bounds(), fine.spacing * factor));
  for (std::size_t i = 0; i < coarse.values.size(); ++i) {
    const Index<Dim> node = (coarse.window.first + coarse.window.local(i)) * factor - fine.first;
    if (fine.inside(node)) coarse[i] = passable.at(node);
  }
  return coarse;
}

/// Passable node nearest to a place within two steps.
template <int Dim>
std::optional<std::size_t> node_near(const Field<Dim, std::uint8_t>& passable, const Vec<Dim>& place) {
  const Grid<Dim>& grid = passable.window;
  const Index<Dim> centre = grid.nearest(place);
  const Grid<Dim> around{1.0, centre.array() - 2, Index<Dim>::Constant(5)};
  std::optional<std::size_t> best;
  double least = kInfinity;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Index<Dim> at = around.first + around.local(i);
    if (!grid.inside(at) || passable.at(at) == 0) continue;
    const double distance = (grid.position(at) - place).norm();
    if (distance < least) least = distance, best = grid.linear(at);
  }
  return best;
}

/// Improves an order by local moves.
class Shortener {
 public:
  Shortener(const TravelTable& table, bool come_back, const OrderRule& rule) : table_(table), come_back_(come_back), rule_(rule) {}

  std::vector<std::size_t> shorten(std::vector<std::size_t> order) const {
    while (reverse_one(order) || move_one(order)) {
    }
    return order;
  }

 private:
  double leg(const std::vector<std::size_t>& order, std::size_t k) const {
    if (k + 1 < order.size()) return table_(order[k], order[k + 1]);
    return come_back_ ? table_(order[k], order[0]) : 0.0;
  }
  bool take(std::vector<std::size_t>& order, std::vector<std::size_t> other) const {
    if (rule_ && !rule_(other)) return false;
    order = std::move(other);
    return true;
  }
  /// From the k-th to what follows the j-th; 0 after the end of an open tour.
  double leg_over(const std::vector<std::size_t>& order, std::size_t k, std::size_t j) const {
    if (j + 1 < order.size()) return table_(order[k], order[j + 1]);
    return come_back_ ? table_(order[k], order[0]) : 0.0;
  }
  /// What the reversal of the stretch i .. j saves.
  double saving(const std::vector<std::size_t>& order, std::size_t i, std::size_t j) const {
    return leg(order, i - 1) + leg(order, j) - table_(order[i - 1], order[j]) - leg_over(order, i, j);
  }
  /// What moving the i-th to the place after the j-th saves, j not i - 1 or i.
  double move_saving(const std::vector<std::size_t>& order, std::size_t i, std::size_t j) const {
    const double taken_out = leg(order, i - 1) + leg(order, i) - leg_over(order, i - 1, i);
    return taken_out - (table_(order[j], order[i]) + leg_over(order, i, j) - leg(order, j));
  }
  bool reverse_one(std::vector<std::size_t>& order) const {
    for (std::size_t i = 1; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        if (saving(order, i, j) <= kGain) continue;
        std::vector<std::size_t> other = order;
        std::reverse(other.begin() + static_cast<std::ptrdiff_t>(i), other.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        if (take(order, std::move(other))) return true;
      }
    return false;
  }
  bool move_one(std::vector<std::size_t>& order) const {
    for (std::size_t i = 1; i < order.size(); ++i)
      for (std::size_t j = 0; j < order.size(); ++j) {
        if (j + 1 == i || j == i || move_saving(order, i, j) <= kGain) continue;
        std::vector<std::size_t> other = order;
        other.erase(other.begin() + static_cast<std::ptrdiff_t>(i));
        other.insert(other.begin() + static_cast<std::ptrdiff_t>(j < i ? j + 1 : j), order[i]);
        if (take(order, std::move(other))) return true;
      }
    return false;
  }

  const TravelTable& table_;
  bool come_back_;
  const OrderRule& rule_;
};

/// Nearest place next that the rule allows, or if there is none the nearest.
std::vector<std::size_t> nearest_first(const TravelTable& table, const OrderRule& rule) {
  std::vector<std::size_t> order{0}, left;
  for (std::size_t k = 1; k < table.count; ++k) left.push_back(k);
  while (!left.empty()) {
    const std::size_t here = order.back();
    std::stable_sort(left.begin(), left.end(), [&](std::size_t a, std::size_t b) { return table(here, a) < table(here, b); });
    const auto allowed = std::find_if(left.begin(), left.end(), [&](std::size_t next) {
      order.push_back(next);
      const bool good = !rule || rule(order);
      order.pop_back();
      return good;
    });
    const auto next = allowed == left.end() ? left.begin() : allowed;
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

}  // namespace

template <int Dim>
TravelTable travel_table(const Field<Dim, std::uint8_t>& passable, std::span<const Vec<Dim>> places) {
  int factor = 1;
  Field<Dim, std::uint8_t> nodes = passable;
  while (static_cast<double>(nodes.values.size()) * static_cast<double>(places.size()) > kFrontNodes) nodes = thinned(passable, ++factor);
  TravelTable table{places.size(), std::vector<double>(places.size() * places.size())};
  std::vector<std::optional<std::size_t>> near;
  for (const Vec<Dim>& place : places) near.push_back(node_near(nodes, place));
  parallel_for(places.size(), 1, [&](std::size_t a) {
    Field<Dim> arrival;
    if (near[a]) {
      const Seed seed{*near[a], 0.0F};
      arrival = fast_march<Dim>(nodes, std::span(&seed, 1));
    }
    for (std::size_t b = 0; b < places.size(); ++b) {
      const double straight = (places[a] - places[b]).norm();
      const double way = near[a] && near[b] ? static_cast<double>(arrival[*near[b]]) : kInfinity;
      table.metres[a * places.size() + b] = std::isfinite(way) ? std::max(way, straight) : straight;
    }
  });
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      double& one = table.metres[a * places.size() + b];
      double& other = table.metres[b * places.size() + a];
      one = other = std::max(one, other);
    }
  return table;
}

std::vector<std::size_t> tour(const TravelTable& table, bool come_back, const OrderRule& rule) {
  if (table.count == 0) return {};
  return Shortener(table, come_back, rule).shorten(nearest_first(table, rule));
}

template <int Dim>
std::vector<Vec<Dim>> way_between(const Field<Dim, std::uint8_t>& passable, const Vec<Dim>& from, const Vec<Dim>& to) {
  const auto start = node_near(passable, from), goal = node_near(passable, to);
  if (!start || !goal) return {};
  const Seed seed{*goal, 0.0F};
  std::vector<Vec<Dim>> way = descend(fast_march_to<Dim>(passable, std::span(&seed, 1), *start), *start);
  if (way.empty()) return {};
  if (way.front() != from) way.insert(way.begin(), from);
  if (way.back() != to) way.push_back(to);
  return way;
}

template <int Dim>
double length_of(std::span<const Vec<Dim>> path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

#define VANTAGE_INSTANTIATE(D)                                                                              \
  template TravelTable travel_table<D>(const Field<D, std::uint8_t>&, std::span<const Vec<D>>);          \
  template std::vector<Vec<D>> way_between<D>(const Field<D, std::uint8_t>&, const Vec<D>&, const Vec<D>&); \
  template double length_of<D>(std::span<const Vec<D>>);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
