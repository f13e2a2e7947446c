// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/preview.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kOpen = 0.05;   // A boundary that opens with less is no surface that could be registered, nor much to see.
constexpr double kFaint = 0.02;  // What is shown with less counts as hidden.

/// e^-x for a small x >= 0, by + * / alone.
double fading(double x) {
  double value = 1.0 / (1.0 + x / 64.0);
  for (int k = 0; k < 6; ++k) value *= value;
  return value;
}

}  // namespace

template <int Dim>
Facing<Dim>::Facing(std::span<const BoundaryFace<Dim>> faces, double least) : least_(least) {
  if (least <= 0.0) return;
  for (const BoundaryFace<Dim>& face : faces) normals_.try_emplace(face.unseen, Vec<Dim>::Zero()).first->second += face.normal;
}

template <int Dim>
bool Facing<Dim>::holds(std::size_t unseen, const Vec<Dim>& direction) const {
  const auto found = any() ? normals_.end() : normals_.find(unseen);
  return found == normals_.end() || -direction.dot(found->second) >= least_ * found->second.norm();
}

template <int Dim>
Preview<Dim>::Preview(const BeliefView<Dim>& view, const Field<Dim>& openness, const Medium& medium, const Facing<Dim>& facing)
    : view_(view),
      openness_(openness),
      grid_(view.window()),
      fade_(fading(0.5 * medium.opacity * grid_.spacing)),
      range_(medium.range),
      facing_(facing) {}

/// Calls visit(node) every half cell, from one cell off the start on, while it returns true.
template <int Dim>
template <class Visit>
void Preview<Dim>::walk(const Vec<Dim>& from, const Vec<Dim>& direction, double length, Visit&& visit) const {
  const Vec<Dim> start = from / grid_.spacing, step = 0.5 * direction;
  const auto samples = static_cast<int>(2.0 * length / grid_.spacing);
  for (int k = 2; k < samples; ++k) {
    const Vec<Dim> p = start + static_cast<double>(k) * step;
    Index<Dim> node;
    for (int a = 0; a < Dim; ++a) node[a] = static_cast<std::int32_t>(std::floor(p[a] + 0.5)) - grid_.first[a];
    if (!grid_.inside(node) || !visit(grid_.linear(node))) return;
  }
}

template <int Dim>
std::vector<Vec<Dim>> Preview<Dim>::frontal(const Vec<Dim>& from, std::span<const Vec<Dim>> directions) const {
  std::vector<Vec<Dim>> kept;
  for (const Vec<Dim>& d : directions)
    walk(from, d, range_, [&](std::size_t i) {
      if (view_.state[i] == NodeState::unseen && facing_.holds(i, d)) kept.push_back(d);
      return view_.state[i] == NodeState::seen;
    });
  return kept;
}

template <int Dim>
double Preview<Dim>::shows(const Vec<Dim>& from, std::size_t node) const {
  const Vec<Dim> offset = grid_.position(node) - from;
  const double distance = offset.norm();
  if (distance > range_) return 0.0;
  double open = -1.0, through = 1.0;
  bool obstacle = false;
  walk(from, offset / distance, distance - 0.5 * grid_.spacing, [&](std::size_t i) {
    const NodeState state = view_.state[i];
    obstacle = state == NodeState::obstacle;
    if (obstacle) return false;
    if (state == NodeState::unseen) {
      if (open < 0.0 && !facing_.holds(i, offset / distance)) through = 0.0;
      open = std::max(open, static_cast<double>(openness_[i]));
      through *= fade_;
    }
    return through > kFaint;
  });
  if (obstacle || through <= kFaint) return 0.0;
  return std::max(open < 0.0 ? static_cast<double>(openness_[node]) : open, 0.0) * through;
}

template <int Dim>
void Preview<Dim>::take(const Vec<Dim>& place, Field<Dim>& left) const {
  parallel_for(grid_.size(), 1024, [&](std::size_t i) {
    if (view_.state[i] == NodeState::unseen && left[i] > 0.0F) left[i] *= static_cast<float>(1.0 - shows(place, i));
  });
}

template <int Dim>
double Preview<Dim>::overlap(const Vec<Dim>& from, std::span<const Vec<Dim>> directions) const {
  std::int64_t known = 0, open = 0;
  for (const Vec<Dim>& d : directions)
    walk(from, d, range_, [&](std::size_t i) {
      if (view_.state[i] == NodeState::seen) return true;
      known += view_.state[i] == NodeState::obstacle ? 1 : 0;
      open += view_.state[i] == NodeState::unseen && static_cast<double>(openness_[i]) > kOpen ? 1 : 0;
      return false;
    });
  return known + open > 0 ? static_cast<double>(known) / static_cast<double>(known + open) : 0.0;
}

template class Facing<2>;
template class Facing<3>;
template class Preview<2>;
template class Preview<3>;

}  // namespace vantage
