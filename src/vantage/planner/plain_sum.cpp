// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/plain_sum.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {
namespace {

constexpr std::size_t kLeaf = 64;
constexpr int kLanes = 8;   // Elements summed side by side.
constexpr int kSlopes = 3;  // Classes of normals along each of the two other axes.

using Lanes = Eigen::Array<float, kLanes, 1>;

/// Normals that look alike have the same number: the face of a cube they point to, in kSlopes^(Dim-1) parts.
template <int Dim>
int heading(const Vec<Dim>& normal) {
  int axis = 0;
  const double most = normal.cwiseAbs().maxCoeff(&axis);
  int number = 2 * axis + (normal[axis] > 0.0 ? 1 : 0);
  for (int a = 0; a < Dim; ++a)
    if (a != axis) number = kSlopes * number + std::min(kSlopes - 1, static_cast<int>(0.5 * kSlopes * (1.0 + normal[a] / most)));
  return number;
}

template <int Dim>
constexpr int headings() {
  int count = 2 * Dim;
  for (int a = 1; a < Dim; ++a) count *= kSlopes;
  return count;
}

Lanes to_quarter_power(const Lanes& r, int quarters) {
  Lanes value = quarters >= 4 ? r : Lanes::Ones();
  for (int k = 1; k < quarters / 4; ++k) value *= r;
  if (quarters % 4 >= 2) value *= r.sqrt();
  if (quarters % 2 == 1) value *= r.sqrt().sqrt();
  return value;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
PlainSum<Dim>::PlainSum(std::span<const BoundaryElement<Dim>> elements, const RayMarch<Dim>& rays, const PlannerOptions& options)
    : angle_(options.tree_angle),
      power_((options.normalise ? 1.0 : 0.0) + options.tau_power),
      absolute_(options.facing == PlannerOptions::Facing::absolute) {
  std::array<std::vector<BoundaryElement<Dim>>, headings<Dim>()> alike;
  for (BoundaryElement<Dim> element : elements) {
    element.area *= rays.weight_at(element.place);
    if (element.area == 0.0) continue;
    if (options.facing == PlannerOptions::Facing::behind) element.normal = -element.normal;
    alike[static_cast<std::size_t>(heading<Dim>(element.normal))].push_back(element);
  }
  for (auto& some : alike) {
    if (some.empty()) continue;
    roots_.push_back(static_cast<std::uint32_t>(groups_.size()));
    groups_.emplace_back();
    build(roots_.back(), some);
  }
}

template <int Dim>
  requires SpatialDim<Dim>
void PlainSum<Dim>::measure(Group& group, std::span<const BoundaryElement<Dim>> elements) const {
  Box<Dim> box;
  for (const auto& e : elements) box.extend(e.place);
  group.center = box.center();
  group.flux = group.axis = Vec<Dim>::Zero();
  group.moment.setZero();
  for (const auto& e : elements) {
    const Vec<Dim> offset = e.place - group.center;
    group.radius = std::max(group.radius, offset.norm());
    group.flux += e.area * e.normal;
    group.axis += e.normal;
    group.moment += e.area * offset * e.normal.transpose();
  }
  group.axis.normalize();  // Alike as they are, they do not cancel.
  for (const auto& e : elements) group.cos_spread = std::min(group.cos_spread, e.normal.dot(group.axis));
  group.sin_spread = std::sqrt(std::max(0.0, 1.0 - group.cos_spread * group.cos_spread));
}

template <int Dim>
  requires SpatialDim<Dim>
void PlainSum<Dim>::build(std::uint32_t index, std::span<BoundaryElement<Dim>> elements) {
  measure(groups_[index], elements);
  if (elements.size() <= kLeaf) {
    Group& leaf = groups_[index];
    leaf.begin = static_cast<std::uint32_t>(area_.size());
    for (const auto& element : elements) append(element.place - leaf.center, element);
    while (area_.size() % kLanes != 0) append(Vec<Dim>::Zero(), {Vec<Dim>::Zero(), Vec<Dim>::Zero(), 0.0});
    leaf.end = static_cast<std::uint32_t>(area_.size());
    return;
  }
  Box<Dim> box;
  for (const auto& e : elements) box.extend(e.place);
  int axis = 0;
  box.size().maxCoeff(&axis);
  const std::size_t half = elements.size() / 2;
  std::nth_element(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(half), elements.end(),
                   [axis](const auto& a, const auto& b) { return a.place[axis] < b.place[axis]; });
  const auto parts = static_cast<std::uint32_t>(groups_.size());
  groups_[index].parts = parts;
  groups_.resize(groups_.size() + 2);
  build(parts, elements.first(half));
  build(parts + 1, elements.subspan(half));
}

/// Whether all elements face the place, or none does: by the cone of their normals and the ball of their places.
template <int Dim>
  requires SpatialDim<Dim>
auto PlainSum<Dim>::side(const Group& group, const Vec<Dim>& offset, double distance) const -> Side {
  if (distance <= group.radius || group.cos_spread <= 0.0) return Side::both;
  const double along = offset.dot(group.axis) / distance;  // Cosine between the axis and the way to the place.
  const double sin_ball = group.radius / distance, cos_ball = std::sqrt(1.0 - sin_ball * sin_ball);
  if (group.cos_spread * cos_ball <= group.sin_spread * sin_ball) return Side::both;  // The two angles add up to 90 degrees or more.
  constexpr double kRounding = 1e-9;
  const double margin = group.sin_spread * cos_ball + group.cos_spread * sin_ball + kRounding;
  return along > margin ? Side::front : along < -margin ? Side::back : Side::both;
}

/// Terms n.f(d - (y - center)) with f(d) = d |d|^-p, expanded to the first order.
template <int Dim>
  requires SpatialDim<Dim>
double PlainSum<Dim>::from_afar(const Group& group, const Vec<Dim>& offset, double distance) const {
  const Vec<Dim> unit = offset / distance;
  const double first = group.flux.dot(offset), second = group.moment.trace() - power_ * unit.dot(group.moment * unit);
  return std::abs(first - second) * inverse_power(distance, power_);
}

template <int Dim>
  requires SpatialDim<Dim>
double PlainSum<Dim>::one_by_one(const Group& group, const Vec<Dim>& offset) const {
  const auto quarters = static_cast<int>(4.0 * power_);
  const Eigen::Matrix<float, Dim, 1> from = offset.template cast<float>();
  constexpr float kHere = 1e-30F;  // An element at the place itself counts nothing.
  Lanes sum = Lanes::Zero();
  for (std::uint32_t i = group.begin; i < group.end; i += kLanes) {
    const auto of = [i](const std::vector<float>& all) { return Eigen::Map<const Lanes>(all.data() + i); };
    Lanes facing = Lanes::Zero(), square = Lanes::Constant(kHere);
    for (int a = 0; a < Dim; ++a) {
      const Lanes d = from[a] - of(place_[a]);
      facing += d * of(normal_[a]);
      square += d * d;
    }
    facing = absolute_ ? Lanes(facing.abs()) : Lanes(facing.max(0.0F));
    sum += of(area_) * facing / to_quarter_power(square.sqrt(), quarters);
  }
  return static_cast<double>(sum.sum());
}

template <int Dim>
  requires SpatialDim<Dim>
void PlainSum<Dim>::append(const Vec<Dim>& offset, const BoundaryElement<Dim>& element) {
  for (int a = 0; a < Dim; ++a) {
    place_[a].push_back(static_cast<float>(offset[a]));
    normal_[a].push_back(static_cast<float>(element.normal[a]));
  }
  area_.push_back(static_cast<float>(element.area));
}

template <int Dim>
  requires SpatialDim<Dim>
double PlainSum<Dim>::at(const Vec<Dim>& z) const {
  double sum = 0.0;
  std::vector<std::uint32_t> open(roots_.rbegin(), roots_.rend());
  while (!open.empty()) {
    const Group& group = groups_[open.back()];
    open.pop_back();
    const Vec<Dim> offset = z - group.center;
    const double distance = offset.norm();
    const Side seen = side(group, offset, distance);
    if (seen == Side::back && !absolute_) continue;
    if (seen != Side::both && group.radius < angle_ * distance) {
      sum += from_afar(group, offset, distance);
    } else if (group.parts == 0) {
      sum += one_by_one(group, offset);
    } else {
      open.push_back(group.parts + 1);
      open.push_back(group.parts);
    }
  }
  return sum;
}

template class PlainSum<2>;
template class PlainSum<3>;

}  // namespace vantage
