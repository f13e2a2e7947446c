// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/ray_march.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// e^-x for x >= 0 with + - * / only, good to 1e-9: halved six times, a series, squared six times.
double exp_minus(double x) {
  if (x > 30.0) return 0.0;
  const double y = x / 64.0;
  double e = 1.0 - y * (1.0 - y / 2.0 * (1.0 - y / 3.0 * (1.0 - y / 4.0 * (1.0 - y / 5.0 * (1.0 - y / 6.0)))));
  for (int k = 0; k < 6; ++k) e *= e;
  return e;
}

template <int Dim>
double cell_power(double r) {  // r^(Dim-1)
  double value = 1.0;
  for (int a = 1; a < Dim; ++a) value *= r;
  return value;
}

}  // namespace

double inverse_power(double x, double power) {
  double value = 1.0;
  for (; power >= 1.0; power -= 1.0) value /= x;
  if (power >= 0.5) {
    value /= std::sqrt(x);
    power -= 0.5;
  }
  if (power >= 0.25) value /= std::sqrt(std::sqrt(x));
  return value;
}

template <int Dim>
  requires SpatialDim<Dim>
RayMarch<Dim>::RayMarch(const BeliefView<Dim>& view, const Field<Dim>& openness, const Medium& medium)
    : view_(view), openness_(openness), medium_(medium) {}

template <int Dim>
  requires SpatialDim<Dim>
bool RayMarch<Dim>::locate(const Vec<Dim>& place, std::size_t& node) const {
  const Grid<Dim>& grid = view_.window();
  node = 0;
  for (int a = Dim - 1; a >= 0; --a) {
    const auto i = static_cast<std::int32_t>(std::floor(place[a] + 0.5));
    if (i < 0 || i >= grid.extent[a]) return false;
    node = node * static_cast<std::size_t>(grid.extent[a]) + static_cast<std::size_t>(i);
  }
  return true;
}

template <int Dim>
  requires SpatialDim<Dim>
typename RayMarch<Dim>::Stop RayMarch<Dim>::march(const Vec<Dim>& start, const Vec<Dim>& direction, double limit) const {
  const double cells = 1.0 / view_.window().spacing;
  // A node's psi is its distance to the nearest node not seen, less half a cell; the sample is up to half a diagonal off its node, and so may be the
  // place where another node becomes the nearest.
  const double slack = std::sqrt(static_cast<double>(Dim)) - 0.5;
  // The observer stands in free space even where the lattice calls its own node an obstacle.
  const double own = std::sqrt(static_cast<double>(Dim));
  Stop stop;
  double t = 0.0;
  while (t < limit) {
    if (!locate(start + t * direction, stop.node)) {
      stop.range = t;
      return stop;
    }
    if (!view_.seen(stop.node) && t > own) {
      stop.range = t;
      stop.inside = true;
      return stop;
    }
    t += std::max(0.5, static_cast<double>(view_.psi[stop.node]) * cells - slack);
  }
  stop.range = limit;
  return stop;
}

template <int Dim>
  requires SpatialDim<Dim>
void RayMarch<Dim>::add_beyond(const Vec<Dim>& start, const Vec<Dim>& direction, const Stop& stop, double solid_angle, RaySums& sums) const {
  // The first unseen node may be met over a corner and have no face to a seen one: the next along the ray then carries the probability.
  double t = stop.range, weight = 0.0;
  std::size_t node = stop.node;
  const double give_up = t + std::sqrt(static_cast<double>(Dim));
  while (weight == 0.0) {
    if (view_.state[node] == NodeState::obstacle) return;
    weight = static_cast<double>(openness_[node]);
    if (weight > 0.0) break;
    t += 0.5;
    if (t > give_up || !locate(start + t * direction, node) || view_.seen(node)) return;
  }
  const auto priority = [&](std::size_t at) { return medium_.weight == nullptr ? 1.0 : static_cast<double>((*medium_.weight)[at]); };
  const double h = view_.window().spacing, limit = medium_.max_range / h, here = priority(node);
  sums.solid_angle += here * weight * solid_angle;
  sums.area += here * weight * solid_angle * cell_power<Dim>(stop.range * h) * inverse_power(std::max(stop.range * h, 1e-9), medium_.tau_power);
  const double fade = exp_minus(medium_.lambda * h);  // Over one cell of the unseen.
  double transmitted = weight * solid_angle * h;
  for (t = stop.range; t < limit; t += 1.0) {
    if (!locate(start + t * direction, node) || view_.state[node] == NodeState::obstacle) return;
    if (view_.seen(node)) continue;
    sums.volume += priority(node) * transmitted * cell_power<Dim>(t * h);
    transmitted *= fade;
    if (transmitted < 1e-6 * solid_angle) return;
  }
}

template <int Dim>
  requires SpatialDim<Dim>
RaySums RayMarch<Dim>::look(const Vec<Dim>& origin, std::span<const Vec<Dim>> directions) const {
  const Grid<Dim>& grid = view_.window();
  const Vec<Dim> start = origin / grid.spacing - grid.first.template cast<double>();
  const double solid_angle = 2.0 * kPi * (Dim - 1) / static_cast<double>(directions.size());
  RaySums sums;
  for (const Vec<Dim>& direction : directions) {
    const Stop stop = march(start, direction, medium_.max_range / grid.spacing);
    if (stop.inside) add_beyond(start, direction, stop, solid_angle, sums);
  }
  return sums;
}

template <int Dim>
  requires SpatialDim<Dim>
bool RayMarch<Dim>::line_of_sight(const Vec<Dim>& from, const Vec<Dim>& to, double slack) const {
  const Grid<Dim>& grid = view_.window();
  const Vec<Dim> offset = (to - from) / grid.spacing;
  const double distance = offset.norm(), limit = distance - slack / grid.spacing;
  if (limit <= 0.0) return true;
  const Vec<Dim> start = from / grid.spacing - grid.first.template cast<double>();
  return march(start, offset / distance, limit).range >= limit;
}

template <int Dim>
  requires SpatialDim<Dim>
double RayMarch<Dim>::weight_at(const Vec<Dim>& place) const {
  if (medium_.weight == nullptr) return 1.0;
  const Index<Dim> node = view_.window().nearest(place);
  return view_.window().inside(node) ? static_cast<double>(medium_.weight->at(node)) : 1.0;
}

template <int Dim>
double measured_opacity(const BeliefView<Dim>& view) {
  struct Count {
    double walls = 0.0, seen = 0.0;
  };
  const Grid<Dim>& grid = view.window();
  const Count total = parallel_reduce(
      grid.size(), std::size_t{1} << 15, Count{},
      [&](std::size_t begin, std::size_t end) {
        Count count;
        for (std::size_t i = begin; i < end; ++i) {
          if (!view.seen(i)) continue;
          count.seen += 1.0;
          if (static_cast<double>(view.psi[i]) > 0.6 * grid.spacing) continue;
          const Index<Dim> node = grid.local(i);
          for (int a = 0; a < Dim; ++a) {
            const std::size_t stride = grid.stride(a);
            if (node[a] > 0 && view.state[i - stride] == NodeState::obstacle) count.walls += 1.0;
            if (node[a] + 1 < grid.extent[a] && view.state[i + stride] == NodeState::obstacle) count.walls += 1.0;
          }
        }
        return count;
      },
      [](Count& sum, const Count& part) {
        sum.walls += part.walls;
        sum.seen += part.seen;
      });
  // Lattice faces overcount a surface of random direction by 4/pi in 2D and 3/2 in 3D; chords are pi V / A and 4 V / A long.
  constexpr std::array<double, 2> kTrueArea{kPi / 4.0, 2.0 / 3.0}, kChord{kPi, 4.0};
  if (total.seen == 0.0) return 0.0;
  return total.walls * kTrueArea[Dim - 2] / (kChord[Dim - 2] * total.seen * grid.spacing);
}

template class RayMarch<2>;
template class RayMarch<3>;
template double measured_opacity<2>(const BeliefView<2>&);
template double measured_opacity<3>(const BeliefView<3>&);

}  // namespace vantage
