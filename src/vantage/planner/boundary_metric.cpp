// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/boundary_metric.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/field/stencil.h"

namespace vantage {
namespace {

using Mask = PlannerOptions::Mask;

template <int Dim>
double power(double h, int exponent) {
  double value = 1.0;
  for (int k = 0; k < exponent; ++k) value *= h;
  return value;
}

template <int Dim>
bool passes(const BoundaryFace<Dim>& face, Mask mask) {
  return mask != Mask::both || (face.frontal <= 0.3 && face.frontal_views < 2);
}

/// Faces between a seen node and an obstacle: part of the boundary of S, and of the sum when nothing is masked.
template <int Dim>
void add_surface_faces(const BeliefView<Dim>& view, std::vector<BoundaryElement<Dim>>& elements) {
  const Grid<Dim>& grid = view.window();
  for (std::size_t p = 0; p < grid.size(); ++p) {
    if (!view.seen(p) || static_cast<double>(view.psi[p]) > 0.6 * grid.spacing) continue;
    const Index<Dim> here = grid.local(p);
    for (int direction = 0; direction < 2 * Dim; ++direction) {
      Index<Dim> there = here;
      there[direction / 2] += direction % 2 == 0 ? 1 : -1;
      if (!grid.inside(there) || view.state.at(there) != NodeState::obstacle) continue;
      const Vec<Dim> slope = gradient(view.psi, here) + gradient(view.psi, there);
      if (slope.norm() < 1e-9) continue;
      elements.push_back({0.5 * (grid.position(here) + grid.position(there)), slope.normalized(), 0.0});
      elements.back().area = power<Dim>(grid.spacing, Dim - 1) * std::abs(elements.back().normal[direction / 2]);
    }
  }
}

/// The node of the boundary nearest to `node`: of those not seen within two cells, the nearest to its projection on psi = 0.
template <int Dim>
bool borders_unseen(const BeliefView<Dim>& view, const Index<Dim>& node, const Vec<Dim>& normal) {
  const Grid<Dim>& grid = view.window();
  const Vec<Dim> foot = grid.position(node) - static_cast<double>(view.psi.at(node)) * normal;
  double nearest = kInfinity;
  bool unseen = false;
  int neighbours = 1;
  for (int a = 0; a < Dim; ++a) neighbours *= 3;
  const Index<Dim> center = grid.nearest(foot);
  for (int code = 0; code < neighbours; ++code) {
    Index<Dim> other = center;
    for (int a = 0, rest = code; a < Dim; ++a, rest /= 3) other[a] += rest % 3 - 1;
    if (!grid.inside(other) || view.state.at(other) == NodeState::seen) continue;
    const double distance = (grid.position(other) - foot).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    unseen = view.state.at(other) == NodeState::unseen;
  }
  return unseen;
}

template <int Dim>
std::vector<BoundaryElement<Dim>> smeared_elements(const BeliefView<Dim>& view, const PlannerOptions& options) {
  const Grid<Dim>& grid = view.window();
  const double epsilon = 2.0 * grid.spacing, cell = power<Dim>(grid.spacing, Dim);
  const auto delta = options.elements == PlannerOptions::Elements::printed ? printed_delta : smeared_delta;
  const Field<Dim> psi = smooth(view.psi, 1);  // One pass before differences, for the normals of a binary set.
  std::vector<BoundaryElement<Dim>> elements;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double weight = delta(static_cast<double>(view.psi[i]), epsilon);
    if (weight <= 0.0) continue;
    const Index<Dim> node = grid.local(i);
    const Vec<Dim> slope = gradient(psi, node);
    if (slope.norm() < 1e-9) continue;
    const Vec<Dim> normal = slope.normalized();
    if (options.mask != Mask::none && !borders_unseen(view, node, normal)) continue;
    elements.push_back({grid.position(node), normal, weight * cell});
  }
  return elements;
}

}  // namespace

template <int Dim>
std::vector<BoundaryElement<Dim>> boundary_elements(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces,
                                                    const PlannerOptions& options) {
  if (options.elements != PlannerOptions::Elements::faces) return smeared_elements(view, options);
  std::vector<BoundaryElement<Dim>> elements;
  const double area = power<Dim>(view.window().spacing, Dim - 1);
  for (const BoundaryFace<Dim>& face : faces)
    if (passes(face, options.mask)) elements.push_back({face.center, face.normal, area * std::abs(face.normal[face.direction / 2])});
  if (options.mask == Mask::none) add_surface_faces(view, elements);
  return elements;
}

template <int Dim>
double boundary_metric(std::span<const BoundaryElement<Dim>> elements, const RayMarch<Dim>& rays, const Vec<Dim>& z, const PlannerOptions& options) {
  using Facing = PlannerOptions::Facing;
  double sum = 0.0;
  for (const BoundaryElement<Dim>& element : elements) {
    const Vec<Dim> offset = z - element.place;
    const double distance = offset.norm();
    if (distance == 0.0) continue;
    double facing = offset.dot(element.normal);
    if (options.facing == Facing::behind) facing = -facing;
    if (options.facing == Facing::absolute) facing = std::abs(facing);
    if (facing <= 0.0) continue;
    if (options.normalise) facing /= distance;
    if (options.tau_power > 0.0) facing *= inverse_power(distance, options.tau_power);
    if (options.line_of_sight && !rays.line_of_sight(z, element.place, 2.0 * rays.spacing())) continue;
    sum += element.area * facing * rays.weight_at(element.place);
  }
  return sum;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                                  \
  template std::vector<BoundaryElement<D>> boundary_elements<D>(const BeliefView<D>&, std::span<const BoundaryFace<D>>, const PlannerOptions&); \
  template double boundary_metric<D>(std::span<const BoundaryElement<D>>, const RayMarch<D>&, const Vec<D>&, const PlannerOptions&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
