// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/verdict.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/planner/regions.h"

namespace vantage {
namespace {

/// What hangs together and is unseen.
template <int Dim>
struct Part {
  double nodes = 0.0;
  double deepest = 0.0;                                  // Largest -psi [m].
  Index<Dim> low, high;                                  // Inclusive.
  double open = 0.0, open_most = 0.0, open_least = 0.0;  // What its faces may open [m^Dim].
  bool has_face = false, reachable = false;
};

template <int Dim>
std::vector<Part<Dim>> parts_of(const BeliefView<Dim>& view, const Regions<Dim>& regions) {
  const Grid<Dim>& grid = view.window();
  std::vector<Part<Dim>> parts(regions.count());
  for (std::size_t r = 0; r < regions.rows(); ++r)
    for (const auto& run : regions.row(r)) {
      Part<Dim>& part = parts[static_cast<std::size_t>(run.region)];
      const std::size_t first = r * regions.row_length();
      const Index<Dim> begin = grid.local(first + run.begin), end = grid.local(first + run.end - 1);
      part.low = part.nodes > 0.0 ? Index<Dim>(part.low.cwiseMin(begin)) : begin;
      part.high = part.nodes > 0.0 ? Index<Dim>(part.high.cwiseMax(end)) : end;
      part.nodes += static_cast<double>(run.end - run.begin);
      const float least = *std::min_element(view.psi.values.begin() + static_cast<std::ptrdiff_t>(first + run.begin),
                                            view.psi.values.begin() + static_cast<std::ptrdiff_t>(first + run.end));
      part.deepest = std::max(part.deepest, -static_cast<double>(least));
    }
  return parts;
}

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

/// Bounding box of the nodes that are 1 [m].
template <int Dim>
Box<Dim> bounds_of(const Field<Dim, std::uint8_t>& nodes) {
  const auto length = static_cast<std::size_t>(nodes.window.extent[0]);
  Box<Dim> box;
  for (std::size_t first = 0; first < nodes.values.size(); first += length) {
    const auto row = nodes.values.begin() + static_cast<std::ptrdiff_t>(first), end = row + static_cast<std::ptrdiff_t>(length);
    const auto begin = std::find(row, end, 1);
    if (begin == end) continue;
    const auto behind = std::find(std::make_reverse_iterator(end), std::make_reverse_iterator(begin), 1).base();
    box.extend(nodes.window.position(first + static_cast<std::size_t>(begin - row)));
    box.extend(nodes.window.position(first + static_cast<std::size_t>(behind - row) - 1));
  }
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
std::size_t seen_nodes(const BeliefView<Dim>& view) {
  return parallel_reduce(
      view.state.values.size(), std::size_t{1} << 16, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) count += view.seen(i) ? 1 : 0;
        return count;
      },
      [](std::size_t& sum, std::size_t part) { sum += part; });
}

template <int Dim>
Verdict<Dim> assess(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Field<Dim, std::uint8_t>& reachable,
                    const AssessOptions& options) {
  const Grid<Dim>& grid = view.window();
  const double h = grid.spacing, cell = cell_measure<Dim>(h, Dim), face_area = cell_measure<Dim>(h, Dim - 1);
  const Regions<Dim> regions(grid, [&](std::size_t first, std::span<std::uint8_t> row) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = view.state[first + k] == NodeState::unseen;
  });
  std::vector<Part<Dim>> parts = parts_of(view, regions);
  // Behind a face that opens one sees as deep as it goes, or a mean free path.
  const double free_path = options.opacity > 0.0 ? 1.0 / options.opacity : kInfinity;
  for (const BoundaryFace<Dim>& face : faces) {
    Part<Dim>& part = parts[static_cast<std::size_t>(regions.region_of(face.unseen))];
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
  for (const Part<Dim>& part : parts) {
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

  const double seen = static_cast<double>(seen_nodes(view)) * cell;
  const auto share = [&](double rest) { return seen + rest > 0.0 ? seen / (seen + rest) : 0.0; };
  verdict.seen_fraction = share(open);
  verdict.seen_low = share(open_most);
  verdict.seen_high = share(open_least);
  return verdict;
}

template std::size_t seen_nodes<2>(const BeliefView<2>&);
template std::size_t seen_nodes<3>(const BeliefView<3>&);
template Verdict<2> assess<2>(const BeliefView<2>&, std::span<const BoundaryFace<2>>, const Field<2, std::uint8_t>&, const AssessOptions&);
template Verdict<3> assess<3>(const BeliefView<3>&, std::span<const BoundaryFace<3>>, const Field<3, std::uint8_t>&, const AssessOptions&);

}  // namespace vantage
