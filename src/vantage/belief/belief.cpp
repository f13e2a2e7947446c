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
Belief<Dim>::Belief(const Grid<Dim>& window, double eta)
    : eta_(eta),
      obstacle_distance_(std::max(eta, 0.5 * std::sqrt(static_cast<double>(Dim)) * window.spacing)),
      cap_(kCapCells * window.spacing),
      seen_(window),
      wall_distance_(window, static_cast<float>(cap_)) {
  require_memory(static_cast<double>(window.size()), 24.0, "the lattice");
  state_ = Field<Dim, NodeState>(window, NodeState::unseen);
  psi_ = Field<Dim>(window, static_cast<float>(-cap_));
  known_distance_ = Field<Dim>(window, static_cast<float>(cap_));
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
void Belief<Dim>::unite(const Field<Dim>& phi, std::span<const Vec<Dim>> walls) {
  const auto limit = static_cast<float>(cap_), tolerance = static_cast<float>(eta_);
  seen_.add(phi);
  const Grid<Dim> walled = add_walls(walls), common = intersection(phi.window, state_.window);
  for_common(common, phi.window, state_.window,
             [&](std::size_t from, std::size_t to) { known_distance_[to] = std::min(std::abs(phi[from]) + tolerance, limit); });
  Grid<Dim> changed = judge(common);
  if (!(intersection(walled, common) == walled)) changed = hull(changed, judge(walled));
  redistance_around(changed);
}

/// Settles the known distance and the state of the nodes of `part`; the smallest window of those seen before or now, but not both.
template <int Dim>
  requires SpatialDim<Dim>
Grid<Dim> Belief<Dim>::judge(const Grid<Dim>& part) {
  const Grid<Dim>& window = state_.window;
  const auto length = static_cast<std::size_t>(part.extent[0]), rows = length > 0 ? part.size() / length : 0;
  const auto obstacle = static_cast<float>(obstacle_distance_);
  std::vector<std::array<std::size_t, 2>> changed(rows, {length, 0});  // First and last place of a row.
  parallel_chunks(rows, 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> seen(length);
    for (std::size_t row = begin; row < end; ++row) {
      Index<Dim> node = part.local(row * length) + part.first - window.first;
      const std::size_t first = window.linear(node);
      seen_.read_row(node, seen);
      for (std::size_t k = 0; k < length;) {
        const float* wall = wall_distance_.run(node);
        const std::size_t until = std::min(length, k + static_cast<std::size_t>(Walls::kSide - node[0] % Walls::kSide));
        node[0] += static_cast<std::int32_t>(until - k);
        for (; k < until; ++k) {
          float& known = known_distance_[first + k];
          if (wall != nullptr) known = std::min(known, *wall++);
          const NodeState now = known <= obstacle ? NodeState::obstacle : static_cast<NodeState>(seen[k]);
          NodeState& state = state_[first + k];
          if ((now == NodeState::seen) != (state == NodeState::seen)) changed[row] = {std::min(changed[row][0], k), k};
          state = now;
        }
      }
    }
  });
  Grid<Dim> out{window.spacing, part.first, Index<Dim>::Zero()};
  for (std::size_t row = 0; row < rows; ++row)
    for (const std::size_t k : changed[row])
      if (changed[row][0] < length) out = hull(out, Grid<Dim>{window.spacing, part.first + part.local(row * length + k), Index<Dim>::Ones()});
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
void Belief<Dim>::redistance_around(const Grid<Dim>& changed) {
  if (changed.size() == 0) return;
  // A change reaches as far as the cap; what is within the cap of that must be known to compute it.
  const Grid<Dim> renewed = intersection(padded(changed, kCapCells), state_.window);
  const Grid<Dim> needed = intersection(padded(changed, 2 * kCapCells), state_.window);
  Field<Dim, std::uint8_t> inside(needed);
  for_common(needed, needed, state_.window, [&](std::size_t to, std::size_t from) { inside[to] = state_[from] == NodeState::seen; });
  const Field<Dim> psi = signed_distance(inside, cap_);
  for_common(renewed, psi.window, psi_.window, [&](std::size_t from, std::size_t to) { psi_[to] = psi[from]; });
}

template <int Dim>
  requires SpatialDim<Dim>
double Belief<Dim>::seen_volume() const {
  const auto nodes = std::count(state_.values.begin(), state_.values.end(), NodeState::seen);
  double cell = 1.0;
  for (int a = 0; a < Dim; ++a) cell *= state_.window.spacing;
  return static_cast<double>(nodes) * cell;
}

template class Belief<2>;
template class Belief<3>;

}  // namespace vantage
