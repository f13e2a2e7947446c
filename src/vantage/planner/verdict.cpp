// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/verdict.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Connected unseen nodes (over faces): label per node, -1 for the others.
template <int Dim>
struct Components {
  Field<Dim, std::int32_t> label;

  struct Part {
    double nodes = 0.0;
    double deepest = 0.0;                                  // Largest -psi [m].
    Index<Dim> low, high;                                  // Inclusive.
    double open = 0.0, open_most = 0.0, open_least = 0.0;  // What its faces may open [m^Dim].
    bool has_face = false, reachable = false;
  };
  std::vector<Part> parts;

  explicit Components(const BeliefView<Dim>& view) : label(view.window(), -1) {
    const Grid<Dim>& grid = view.window();
    std::vector<std::size_t> front;
    for (std::size_t first = 0; first < grid.size(); ++first) {
      if (view.state[first] != NodeState::unseen || label[first] >= 0) continue;
      const auto id = static_cast<std::int32_t>(parts.size());
      Part& part = parts.emplace_back();
      part.low = part.high = grid.local(first);
      label[first] = id;
      front.push_back(first);
      while (!front.empty()) {
        const std::size_t node = front.back();
        front.pop_back();
        const Index<Dim> here = grid.local(node);
        part.nodes += 1.0;
        part.deepest = std::max(part.deepest, -static_cast<double>(view.psi[node]));
        part.low = part.low.cwiseMin(here);
        part.high = part.high.cwiseMax(here);
        const auto enter = [&](std::size_t next) {
          if (view.state[next] != NodeState::unseen || label[next] >= 0) return;
          label[next] = id;
          front.push_back(next);
        };
        for (int a = 0; a < Dim; ++a) {
          if (here[a] > 0) enter(node - grid.stride(a));
          if (here[a] + 1 < grid.extent[a]) enter(node + grid.stride(a));
        }
      }
    }
  }
};

/// Length of the unseen straight behind a face, at most `limit` [m].
template <int Dim>
double depth_behind(const BeliefView<Dim>& view, const BoundaryFace<Dim>& face, double limit) {
  const Grid<Dim>& grid = view.window();
  const int axis = face.direction / 2, inward = face.direction % 2 == 0 ? 1 : -1;
  double depth = 0.0;
  for (Index<Dim> node = grid.local(face.unseen); grid.inside(node) && view.state.at(node) == NodeState::unseen && depth < limit;
       node[axis] += inward)
    depth += grid.spacing;
  return std::min(depth, limit);
}

/// Bounding box of the nodes that are not 0 [m].
template <int Dim>
Box<Dim> bounds_of(const Field<Dim, std::uint8_t>& nodes) {
  Box<Dim> box;
  for (std::size_t i = 0; i < nodes.values.size(); ++i)
    if (nodes[i] != 0) box.extend(nodes.window.position(i));
  return box;
}

/// Distance between two boxes; 0 if they meet [m].
template <int Dim>
double gap(const Box<Dim>& a, const Box<Dim>& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).norm();
}

template <int Dim>
double cell_measure(double h, int power) {
  double value = 1.0;
  for (int k = 0; k < power; ++k) value *= h;
  return value;
}

}  // namespace

template <int Dim>
Verdict<Dim> assess(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Field<Dim, std::uint8_t>& reachable,
                    const AssessOptions& options) {
  const Grid<Dim>& grid = view.window();
  const double h = grid.spacing, cell = cell_measure<Dim>(h, Dim), face_area = cell_measure<Dim>(h, Dim - 1);
  Components<Dim> components(view);
  // Behind a face that opens one sees as deep as it goes, or a mean free path.
  const double free_path = options.opacity > 0.0 ? 1.0 / options.opacity : kInfinity;
  for (const BoundaryFace<Dim>& face : faces) {
    auto& part = components.parts[static_cast<std::size_t>(components.label[face.unseen])];
    const double behind = face_area * depth_behind(view, face, free_path);
    part.has_face = true;
    part.reachable = part.reachable || reachable[face.seen] != 0;
    part.open += behind * face.probability;
    part.open_most += behind * std::min(1.0, 2.0 * face.probability);
    part.open_least += face.probability >= 0.9 ? behind * face.probability : 0.0;  // What is all but sure.
  }

  const Box<Dim> ground = bounds_of(reachable);
  double open = 0.0, open_most = 0.0, open_least = 0.0;
  Verdict<Dim> verdict;
  for (const auto& part : components.parts) {
    const double volume = part.nodes * cell;
    open += std::min(volume, part.open);
    open_most += std::min(volume, part.open_most);
    open_least += std::min(volume, part.open_least);
    verdict.unseen_volume += volume;
    if (volume < options.least_volume) continue;
    UnseenRegion<Dim> region;
    region.volume = volume;
    region.may_open = std::min(volume, part.open);
    region.box = {grid.position(part.low).array() - 0.5 * h, grid.position(part.high).array() + 0.5 * h};
    if (!part.has_face)
      region.reason = "enclosed";
    else if (part.deepest < h)
      region.reason = "too fine for the lattice";
    else if (!part.reachable)
      region.reason = gap(region.box, ground) > options.max_range ? "beyond range" : "no reachable view";
    else
      region.reason = "below the threshold";
    verdict.unseen.push_back(region);
  }
  std::stable_sort(verdict.unseen.begin(), verdict.unseen.end(), [](const auto& a, const auto& b) { return a.volume > b.volume; });

  const auto seen = static_cast<double>(std::count(view.state.values.begin(), view.state.values.end(), NodeState::seen)) * cell;
  const auto share = [&](double rest) { return seen + rest > 0.0 ? seen / (seen + rest) : 0.0; };
  verdict.seen_fraction = share(open);
  verdict.seen_low = share(open_most);
  verdict.seen_high = share(open_least);
  return verdict;
}

template Verdict<2> assess<2>(const BeliefView<2>&, std::span<const BoundaryFace<2>>, const Field<2, std::uint8_t>&, const AssessOptions&);
template Verdict<3> assess<3>(const BeliefView<3>&, std::span<const BoundaryFace<3>>, const Field<3, std::uint8_t>&, const AssessOptions&);

}  // namespace vantage
