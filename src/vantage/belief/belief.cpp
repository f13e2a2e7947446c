// SPDX-License-Identifier: Apache-2.0
#include "vantage/belief/belief.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/field/redistance.h"

namespace vantage {
namespace {

constexpr int kCapCells = 32;

/// Linear index in `to` of the first node of row `row` (along axis 0) of `part`, a window inside `to`.
template <int Dim>
std::size_t row_start(const Grid<Dim>& part, const Grid<Dim>& to, std::size_t row) {
  Index<Dim> local = part.local(row * static_cast<std::size_t>(part.extent[0]));
  local += part.first - to.first;
  return to.linear(local);
}

/// Calls f(index in a, index in b) for every node of `part`, which lies in both windows; rows in parallel.
template <int Dim, class F>
void for_common(const Grid<Dim>& part, const Grid<Dim>& a, const Grid<Dim>& b, F&& f) {
  if (part.size() == 0) return;
  const auto length = static_cast<std::size_t>(part.extent[0]);
  parallel_for(part.size() / length, 256, [&](std::size_t row) {
    const std::size_t ia = row_start(part, a, row), ib = row_start(part, b, row);
    for (std::size_t k = 0; k < length; ++k) f(ia + k, ib + k);
  });
}

/// The smallest window that holds both; an empty one holds nothing.
template <int Dim>
Grid<Dim> hull(const Grid<Dim>& a, const Grid<Dim>& b) {
  if (a.size() == 0 || b.size() == 0) return a.size() == 0 ? b : a;
  Grid<Dim> out = a;
  out.first = a.first.cwiseMin(b.first);
  out.extent = (a.first + a.extent).cwiseMax(b.first + b.extent) - out.first;
  return out;
}

/// Steps from the node nearest to a place to all nodes that may lie within `reach` of the place, both in cells.
template <int Dim>
std::vector<Index<Dim>> steps_within(double reach) {
  const auto side = static_cast<std::int32_t>(std::ceil(reach + 0.5));
  Grid<Dim> cube;
  cube.extent.setConstant(2 * side + 1);
  std::vector<Index<Dim>> steps;
  for (std::size_t i = 0; i < cube.size(); ++i) {
    const Index<Dim> step = cube.local(i).array() - side;
    const Vec<Dim> gap = (step.template cast<double>().cwiseAbs().array() - 0.5 - 1e-6).cwiseMax(0.0);
    if (gap.norm() <= reach) steps.push_back(step);
  }
  return steps;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Belief<Dim>::Belief(const Grid<Dim>& window, double eta, double known_cap)
    : obstacle_distance_(std::max(eta, 0.5 * std::sqrt(static_cast<double>(Dim)) * window.spacing)),
      cap_(kCapCells * window.spacing),
      known_cap_(std::max({known_cap, 2.0 * window.spacing, obstacle_distance_})),
      seen_(window),
      wall_distance_(window, static_cast<float>(known_cap_)),
      boundary_(window) {
  require_memory(static_cast<double>(window.size()), 24.0, "the lattice");
  state_ = Field<Dim, NodeState>(window, NodeState::unseen);
  psi_ = Field<Dim>(window, static_cast<float>(-cap_));
  known_distance_ = Field<Dim>(window, static_cast<float>(known_cap_));
}

template <int Dim>
  requires SpatialDim<Dim>
Grid<Dim> Belief<Dim>::add_walls(std::span<const Vec<Dim>> walls) {
  const Grid<Dim>& window = state_.window;
  const double reach = std::sqrt(static_cast<double>(Dim)) * window.spacing;
  const std::vector<Index<Dim>> steps = steps_within<Dim>(reach / window.spacing);
  Index<Dim> low = window.extent, high = Index<Dim>::Constant(-1);
  for (const Vec<Dim>& wall : walls) {
    const Index<Dim> center = window.nearest(wall);
    // A node this near has heard of this wall already: samples lie dense.
    if (window.inside(center) && static_cast<double>(wall_distance_(center)) < 0.1 * window.spacing) continue;
    const Vec<Dim> rest = window.position(center) - wall;
    for (const Index<Dim>& step : steps) {
      if ((rest + window.spacing * step.template cast<double>()).squaredNorm() > reach * reach * (1.0 + 1e-6)) continue;
      const Index<Dim> node = center + step;
      if (!window.inside(node)) continue;
      const auto distance = static_cast<float>((window.position(node) - wall).norm());
      if (distance > static_cast<float>(reach) || distance >= wall_distance_(node)) continue;
      wall_distance_.at(node) = distance;
      low = low.cwiseMin(node);
      high = high.cwiseMax(node);
    }
  }
  Grid<Dim> touched{window.spacing, window.first + low, high - low};
  touched.extent.array() += 1;
  return (high.array() < 0).any() ? Grid<Dim>{window.spacing, window.first, Index<Dim>::Zero()} : touched;
}

template <int Dim>
  requires SpatialDim<Dim>
void Belief<Dim>::unite(const SeenSet<Dim>& seen, const Field<Dim>& known, std::span<const Vec<Dim>> walls) {
  require(seen.window() == known.window, "belief: what is seen and the known distance must share a window");
  const auto limit = static_cast<float>(known_cap_);
  seen_.unite(seen);
  const Grid<Dim> walled = add_walls(walls), common = intersection(known.window, state_.window);
  for_common(common, known.window, state_.window, [&](std::size_t from, std::size_t to) { known_distance_[to] = std::min(known[from], limit); });
  Change change = judge(common);
  if (!(intersection(walled, common) == walled)) {
    const Change more = judge(walled);
    change = {hull(change.nodes, more.nodes), change.seen + more.seen};
  }
  seen_nodes_ += change.seen;
  boundary_.renew(state_, psi_, hull(hull(common, walled), redistance_around(change.nodes)));
}

/// Settles the known distance and the state of a row of `part`. First and last place that was seen before or is now, but not both, and how many more
/// are seen.
template <int Dim>
  requires SpatialDim<Dim>
std::int64_t Belief<Dim>::judge_row(const Grid<Dim>& part, std::size_t row, std::array<std::size_t, 2>& changed) {
  const auto length = static_cast<std::size_t>(part.extent[0]);
  const auto obstacle = static_cast<float>(obstacle_distance_);
  std::vector<std::uint8_t> seen(length);
  Index<Dim> node = part.local(row * length) + part.first - state_.window.first;
  const std::size_t first = state_.window.linear(node);
  seen_.read_row(node, seen);
  std::int64_t more = 0;
  for (std::size_t k = 0; k < length;) {
    const float* wall = wall_distance_.run(node);
    const std::size_t until = std::min(length, k + static_cast<std::size_t>(Walls::kSide - node[0] % Walls::kSide));
    for (; k < until; ++k, ++node[0]) {
      float& known = known_distance_[first + k];
      if (wall != nullptr) known = std::min(known, *wall++);
      const NodeState now = known <= obstacle ? NodeState::obstacle : static_cast<NodeState>(seen[k]);
      NodeState& state = state_[first + k];
      if (now == state) continue;
      if ((now == NodeState::seen) != (state == NodeState::seen)) {
        changed = {std::min(changed[0], k), k};
        more += now == NodeState::seen ? 1 : -1;
      }
      state = now;
      boundary_.touch(node);
    }
  }
  return more;
}

template <int Dim>
  requires SpatialDim<Dim>
auto Belief<Dim>::judge(const Grid<Dim>& part) -> Change {
  const auto length = static_cast<std::size_t>(part.extent[0]), rows = length > 0 ? part.size() / length : 0;
  std::vector<std::array<std::size_t, 2>> places(rows, {length, 0});
  std::vector<std::int64_t> more(rows);
  parallel_for(rows, 256, [&](std::size_t row) { more[row] = judge_row(part, row, places[row]); });
  Change out{Grid<Dim>{part.spacing, part.first, Index<Dim>::Zero()}};
  for (std::size_t row = 0; row < rows; ++row) {
    out.seen += more[row];
    for (const std::size_t k : places[row])
      if (places[row][0] < length)
        out.nodes = hull(out.nodes, Grid<Dim>{part.spacing, part.first + part.local(row * length + k), Index<Dim>::Ones()});
  }
  return out;
}

/// Renews psi within the cap of `changed`; the window of where that is.
template <int Dim>
  requires SpatialDim<Dim>
Grid<Dim> Belief<Dim>::redistance_around(const Grid<Dim>& changed) {
  if (changed.size() == 0) return changed;
  // A change reaches as far as the cap; what is within the cap of that must be known to compute it.
  const Grid<Dim> renewed = intersection(padded(changed, kCapCells), state_.window);
  const Grid<Dim> needed = intersection(padded(changed, 2 * kCapCells), state_.window);
  Field<Dim, std::uint8_t> inside(needed);
  for_common(needed, needed, state_.window, [&](std::size_t to, std::size_t from) { inside[to] = state_[from] == NodeState::seen; });
  const Field<Dim> psi = signed_distance(inside, cap_);
  const auto length = static_cast<std::size_t>(renewed.extent[0]);
  constexpr auto kSide = static_cast<std::size_t>(ShadowBoundary<Dim>::kSide);
  const auto near = static_cast<float>(ShadowBoundary<Dim>::kReach * state_.window.spacing);
  parallel_for(renewed.size() / length, 256, [&](std::size_t row) {
    Index<Dim> node = renewed.local(row * length) + renewed.first - state_.window.first;
    const float* from = psi.values.data() + row_start(renewed, psi.window, row);
    float* to = psi_.values.data() + state_.window.linear(node);
    for (std::size_t k = 0; k < length;) {
      const std::size_t count = std::min(length - k, kSide - static_cast<std::size_t>(node[0]) % kSide);
      bool matters = false;
      for (std::size_t i = k; i < k + count; ++i) {
        matters |= from[i] != to[i] && std::min(std::abs(from[i]), std::abs(to[i])) < near;
        to[i] = from[i];
      }
      if (matters) boundary_.touch(node);
      k += count;
      node[0] += static_cast<std::int32_t>(count);
    }
  });
  return renewed;
}

template <int Dim>
  requires SpatialDim<Dim>
double Belief<Dim>::seen_volume() const {
  double volume = static_cast<double>(seen_nodes_);
  for (int a = 0; a < Dim; ++a) volume *= state_.window.spacing;
  return volume;
}

template class Belief<2>;
template class Belief<3>;

}  // namespace vantage
