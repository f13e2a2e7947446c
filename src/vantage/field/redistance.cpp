// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/redistance.h"

#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/field/distance.h"
#include "vantage/field/fast_marching.h"
#include "vantage/field/line_minimum.h"
#include "vantage/field/tiled_distance.h"

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

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> signed_distance(const Field<Dim, std::uint8_t>& inside, double cap) {
  if (signed_reach(inside.window.spacing, cap) <= kMaxLimit) return tiled_signed_distance(inside, cap);
  const double half = 0.5 * inside.window.spacing;
  Field<Dim, std::uint8_t> outside(inside.window);
  for (std::size_t i = 0; i < inside.values.size(); ++i) outside[i] = inside[i] == 0;
  Field<Dim> psi = distance_to_set(outside, cap + half);
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
