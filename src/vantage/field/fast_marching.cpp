// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/fast_marching.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace vantage {
namespace {

/// Smallest u >= the used upwind values with sum over axes of max(u - value, 0)^2 = h^2.
template <int Dim>
double solve_upwind(std::array<double, Dim> values, double h) {
  std::sort(values.begin(), values.end());
  double u = values[0] + h;
  double sum = values[0], squares = values[0] * values[0];
  for (int k = 1; k < Dim && u > values[static_cast<std::size_t>(k)]; ++k) {
    const double v = values[static_cast<std::size_t>(k)];
    sum += v;
    squares += v * v;
    const double n = k + 1, discriminant = sum * sum - n * (squares - h * h);
    if (discriminant < 0.0) break;
    u = (sum + std::sqrt(discriminant)) / n;
  }
  return u;
}

/// True if every node nearest to the samples of the straight line from a to b has a finite value.
template <int Dim>
bool line_is_finite(const Field<Dim>& arrival, const Vec<Dim>& a, const Vec<Dim>& b) {
  const auto steps = static_cast<int>(std::ceil((b - a).norm() / (0.25 * arrival.window.spacing)));
  for (int i = 0; i <= steps; ++i) {
    const Index<Dim> node = arrival.window.nearest(a + (b - a) * (static_cast<double>(i) / std::max(steps, 1)));
    if (!arrival.window.inside(node) || !std::isfinite(arrival.at(node))) return false;
  }
  return true;
}

/// Neighbour with the steepest descent; itself if none is lower. A diagonal step needs every node of its cell edge box to be finite.
template <int Dim>
Index<Dim> steepest(const Field<Dim>& arrival, const Index<Dim>& node) {
  int neighbours = 1;
  for (int a = 0; a < Dim; ++a) neighbours *= 3;
  const double here = arrival.at(node);
  Index<Dim> best = node;
  double best_slope = 0.0;
  for (int code = 0; code < neighbours; ++code) {
    Index<Dim> step;
    for (int a = 0, rest = code; a < Dim; ++a, rest /= 3) step[a] = rest % 3 - 1;
    const Index<Dim> next = node + step;
    if (step.isZero() || !arrival.window.inside(next) || !std::isfinite(arrival.at(next))) continue;
    const double slope = (here - static_cast<double>(arrival.at(next))) / std::sqrt(static_cast<double>(step.squaredNorm()));
    if (slope <= best_slope) continue;
    bool open = true;  // Corners of the box spanned by the step.
    for (int corner = 1; corner < (1 << Dim) && open; ++corner) {
      Index<Dim> between = node;
      for (int a = 0; a < Dim; ++a)
        if ((corner >> a & 1) != 0) between[a] += step[a];
      open = std::isfinite(arrival.at(between));
    }
    if (!open) continue;
    best = next;
    best_slope = slope;
  }
  return best;
}

/// Upwind value of a node from its accepted neighbours.
template <int Dim>
double upwind_value(const Field<Dim>& arrival, const Field<Dim, std::uint8_t>& done, const Index<Dim>& node) {
  const Grid<Dim>& grid = arrival.window;
  const std::size_t n = grid.linear(node);
  constexpr float kFar = std::numeric_limits<float>::infinity();
  std::array<double, Dim> values;
  for (int a = 0; a < Dim; ++a) {
    const std::size_t stride = grid.stride(a);
    const float low = node[a] > 0 && done[n - stride] != 0 ? arrival[n - stride] : kFar;
    const float high = node[a] + 1 < grid.extent[a] && done[n + stride] != 0 ? arrival[n + stride] : kFar;
    values[static_cast<std::size_t>(a)] = std::min(low, high);
  }
  return solve_upwind<Dim>(values, grid.spacing);
}

/// The front: nodes in order of value plus `still_to_go`, until `target` is accepted.
template <int Dim, class StillToGo>
Field<Dim> march(const Field<Dim, std::uint8_t>& passable, std::span<const Seed> seeds, StillToGo&& still_to_go, std::size_t target) {
  const Grid<Dim>& grid = passable.window;
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Field<Dim> arrival(grid, kFar);
  Field<Dim, std::uint8_t> done(grid);
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  const auto offer = [&](std::size_t node, float value) {
    if (passable[node] == 0 || done[node] != 0 || arrival[node] <= value) return;
    arrival[node] = value;
    front.emplace(value + still_to_go(node), node);
  };
  for (const auto& [node, value] : seeds) offer(node, value);
  while (!front.empty()) {
    const std::size_t node = front.top().second;
    front.pop();
    if (done[node] != 0) continue;
    done[node] = 1;
    if (node == target) break;
    const Index<Dim> here = grid.local(node);
    for (int side = 0; side < 2 * Dim; ++side) {
      Index<Dim> next = here;
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if (grid.inside(next)) offer(grid.linear(next), static_cast<float>(upwind_value(arrival, done, next)));
    }
  }
  for (std::size_t i = 0; i < arrival.values.size(); ++i)
    if (done[i] == 0) arrival[i] = kFar;  // Tentative values of an early end mean nothing.
  return arrival;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> fast_march(const Field<Dim, std::uint8_t>& passable, std::span<const Seed> seeds) {
  return march(passable, seeds, [](std::size_t) { return 0.0F; }, passable.values.size());
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> fast_march_to(const Field<Dim, std::uint8_t>& passable, std::span<const Seed> seeds, std::size_t target) {
  const Vec<Dim> goal = passable.window.position(target);
  return march(passable, seeds, [&](std::size_t node) { return static_cast<float>((passable.window.position(node) - goal).norm()); }, target);
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<Vec<Dim>> descend(const Field<Dim>& arrival, std::size_t from) {
  if (!std::isfinite(arrival[from])) return {};
  std::vector<Vec<Dim>> raw;
  Index<Dim> node = arrival.window.local(from);
  while (true) {
    raw.push_back(arrival.window.position(node));
    const Index<Dim> next = steepest(arrival, node);
    if (next == node) break;
    node = next;
  }
  std::vector<Vec<Dim>> path{raw.front()};
  for (std::size_t i = 0; i + 1 < raw.size();) {
    std::size_t reach = i + 1;
    // Doubling, then a linear walk back: enough to straighten without trying every pair.
    for (std::size_t jump = 2; i + jump < raw.size() && line_is_finite(arrival, raw[i], raw[i + jump]); jump *= 2) reach = i + jump;
    while (reach + 1 < raw.size() && line_is_finite(arrival, raw[i], raw[reach + 1])) ++reach;
    path.push_back(raw[reach]);
    i = reach;
  }
  return path;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                \
  template Field<D> fast_march<D>(const Field<D, std::uint8_t>&, std::span<const Seed>);                                      \
  template Field<D> fast_march_to<D>(const Field<D, std::uint8_t>&, std::span<const Seed>, std::size_t);                      \
  template std::vector<Vec<D>> descend<D>(const Field<D>&, std::size_t);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
