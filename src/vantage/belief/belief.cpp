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
    : eta_(eta), obstacle_distance_(std::max(eta, 0.5 * std::sqrt(static_cast<double>(Dim)) * window.spacing)), cap_(kCapCells * window.spacing) {
  require_memory(static_cast<double>(window.size()), 40.0, "the lattice");
  seen_ = Field<Dim, std::uint8_t>(window, 0);
  state_ = Field<Dim, NodeState>(window, NodeState::unseen);
  psi_ = Field<Dim>(window, static_cast<float>(-cap_));
  known_distance_ = wall_distance_ = Field<Dim>(window, static_cast<float>(cap_));
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
    if (window.inside(center) && static_cast<double>(wall_distance_.at(center)) < 0.1 * window.spacing) continue;
    for (const Index<Dim>& step : steps) {
      const Index<Dim> node = center + step;
      if (!window.inside(node)) continue;
      float& known = wall_distance_.at(node);
      const double square = (window.position(node) - wall).squaredNorm();
      const double limit = std::min(reach, static_cast<double>(known));
      if (square > limit * limit * (1.0 + 1e-6)) continue;
      const auto distance = static_cast<float>(std::sqrt(square));
      if (distance > static_cast<float>(reach) || distance >= known) continue;
      known = distance;
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
  const auto limit = static_cast<float>(cap_), tolerance = static_cast<float>(eta_), obstacle = static_cast<float>(obstacle_distance_);
  const auto judge = [&](std::size_t i) {
    known_distance_[i] = std::min(known_distance_[i], wall_distance_[i]);
    state_[i] = known_distance_[i] <= obstacle ? NodeState::obstacle : seen_[i] != 0 ? NodeState::seen : NodeState::unseen;
  };
  const Grid<Dim> walled = add_walls(walls), common = intersection(phi.window, state_.window);
  for_common(walled, walled, state_.window, [&](std::size_t, std::size_t i) { judge(i); });
  for_common(common, phi.window, state_.window, [&](std::size_t from, std::size_t to) {
    const float value = phi[from];
    if (value > 0.0F) seen_[to] = 1;
    known_distance_[to] = std::min(std::abs(value) + tolerance, limit);
    judge(to);
  });
  redistance_around(common);
  if (walled.size() > 0 && !(intersection(walled, common) == walled)) redistance_around(walled);
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
