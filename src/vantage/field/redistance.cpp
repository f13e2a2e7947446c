// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/redistance.h"

#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/field/distance.h"
#include "vantage/field/fast_marching.h"
#include "vantage/field/line_minimum.h"
#include "vantage/field/squared_distance.h"

namespace vantage {
namespace {

/// Distance of a node to the zero level crossed on its lattice edges: 1/d^2 = sum over axes of 1/d_axis^2; infinity if no edge crosses.
template <int Dim>
double interface_distance(const Field<Dim>& phi, std::size_t node) {
  const Grid<Dim>& grid = phi.window;
  const Index<Dim> here = grid.local(node);
  const double value = std::abs(phi[node]);
  const bool positive = phi[node] > 0.0F;
  double inverse_squares = 0.0;
  for (int axis = 0; axis < Dim; ++axis) {
    double nearest = kInfinity;
    for (const int side : {-1, 1}) {
      Index<Dim> next = here;
      next[axis] += side;
      if (!grid.inside(next)) continue;
      const float other = phi.at(next);
      if ((other > 0.0F) != positive) nearest = std::min(nearest, grid.spacing * value / (value + std::abs(static_cast<double>(other))));
    }
    if (nearest == 0.0) return 0.0;
    if (std::isfinite(nearest)) inverse_squares += 1.0 / (nearest * nearest);
  }
  return inverse_squares > 0.0 ? 1.0 / std::sqrt(inverse_squares) : kInfinity;
}

/// Signed distance of every signed square from -reach^2 to reach^2 [m].
std::vector<float> signed_distances(int reach, double h, double cap) {
  const int last = reach * reach;
  const double half = 0.5 * h;
  std::vector<float> table;
  for (int s = -last; s <= last; ++s) {
    const auto d = static_cast<float>(std::min(cap + half, std::sqrt(static_cast<double>(std::abs(s))) * h));
    table.push_back(s > 0 ? static_cast<float>(d - half) : static_cast<float>(half - d));
  }
  return table;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> signed_distance(const Field<Dim, std::uint8_t>& inside, double cap) {
  const double h = inside.window.spacing, half = 0.5 * h;
  Field<Dim> psi(inside.window);
  if (const double reach = std::floor((cap + half) / h) + 1.0; reach <= kMaxLimit) {
    const Field<Dim, std::int16_t> squares = signed_squares(inside, static_cast<int>(reach));
    const std::vector<float> table = signed_distances(static_cast<int>(reach), h, cap);
    const int last = static_cast<int>(table.size() / 2);
    parallel_chunks(psi.values.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) psi[i] = table[static_cast<std::size_t>(std::clamp<int>(squares[i], -last, last) + last)];
    });
    return psi;
  }
  Field<Dim, std::uint8_t> outside(inside.window);
  for (std::size_t i = 0; i < inside.values.size(); ++i) outside[i] = inside[i] == 0;
  psi = distance_to_set(outside, cap + half);
  const Field<Dim> depth = distance_to_set(inside, cap + half);
  parallel_for(psi.values.size(), 1 << 14,
               [&](std::size_t i) { psi[i] = inside[i] != 0 ? static_cast<float>(psi[i] - half) : static_cast<float>(half - depth[i]); });
  return psi;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> redistance(const Field<Dim>& phi) {
  Field<Dim> out(phi.window);
  for (const bool positive : {true, false}) {
    Field<Dim, std::uint8_t> side(phi.window);
    std::vector<Seed> seeds;
    for (std::size_t i = 0; i < phi.values.size(); ++i) {
      side[i] = (phi[i] > 0.0F) == positive;
      if (side[i] == 0) continue;
      if (const double d = interface_distance(phi, i); std::isfinite(d)) seeds.emplace_back(i, static_cast<float>(d));
    }
    const Field<Dim> arrival = fast_march(side, seeds);
    for (std::size_t i = 0; i < phi.values.size(); ++i)
      if (side[i] != 0) out[i] = positive ? arrival[i] : -arrival[i];
  }
  return out;
}

#define VANTAGE_INSTANTIATE(D)                                                 \
  template Field<D> signed_distance<D>(const Field<D, std::uint8_t>&, double); \
  template Field<D> redistance<D>(const Field<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
