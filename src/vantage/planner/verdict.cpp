// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/verdict.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/planner/regions.h"

namespace vantage {
namespace {

constexpr double kLattice = 0.005;  // What the place of the lattice may make of a share.
constexpr double kGlimpses = 4.0;   // Nodes; fewer are chance.

/// What hangs together and is unseen.
template <int Dim>
struct Part {
  double nodes = 0.0;
  double clear = 0.0;            // Of them farther than h from the known surface: the others are no loss, nobody can tell them from the surface.
  double deepest = 0.0;          // Largest -psi [m].
  Index<Dim> low, high;          // Inclusive.
  double open = 0.0;             // What its faces are expected to open [m^Dim].
  double rim = 0.0;              // A layer of cells behind its faces [m^Dim].
  double stuck = 0.0;            // Straight behind the faces in the open that stay although someone looked [m^Dim].
  double glimpsed = 0.0;         // Nodes a ray went by.
  std::size_t viewer = kNoNode;  // Sees a part of it that may open.
  bool has_face = false, reachable = false, doubtful = false, squeezed = false;
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
      for (std::size_t i = first + run.begin; i < first + run.end; ++i) part.clear += static_cast<double>(view.known_distance[i]) > grid.spacing;
      const float least = *std::min_element(view.psi.values.begin() + static_cast<std::ptrdiff_t>(first + run.begin),
                                            view.psi.values.begin() + static_cast<std::ptrdiff_t>(first + run.end));
      part.deepest = std::max(part.deepest, -static_cast<double>(least));
    }
  return parts;
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

/// Seen nodes that hang together with the reachable ones, not nearer to the known surface than `least` [m] (1, else 0). The other ones were seen
/// through something narrow.
template <int Dim>
Field<Dim, std::uint8_t> open_air(const BeliefView<Dim>& view, const Field<Dim, std::uint8_t>& reachable, double least) {
  const Grid<Dim>& grid = view.window();
  Field<Dim, std::uint8_t> air = reachable;
  std::vector<std::size_t> queue;
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (air[i] != 0) queue.push_back(i);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const Index<Dim> at = grid.local(queue[k]);
    for (int a = 0; a < Dim; ++a)
      for (const int by : {-1, 1}) {
        const Index<Dim> to = at + by * Index<Dim>::Unit(a);
        if (!grid.inside(to) || air.at(to) != 0 || view.state.at(to) != NodeState::seen || static_cast<double>(view.known_distance.at(to)) < least)
          continue;
        air.at(to) = 1;
        queue.push_back(grid.linear(to));
      }
  }
  return air;
}

/// Behind a face that opens one sees as deep as it goes, or a mean free path.
template <int Dim>
void add_faces(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Field<Dim, std::uint8_t>& reachable,
               const Regions<Dim>& regions, const AssessOptions<Dim>& options, std::vector<Part<Dim>>& parts) {
  const double h = view.window().spacing, face_area = cell_measure<Dim>(h, Dim - 1);
  const double free_path = options.opacity > 0.0 ? 1.0 / options.opacity : kInfinity;
  const bool looked_for = options.last_look != nullptr && options.last_look->asked;
  const Field<Dim, std::uint8_t> air = looked_for ? open_air(view, reachable, 0.8 * h) : Field<Dim, std::uint8_t>{};
  for (const BoundaryFace<Dim>& face : faces) {
    Part<Dim>& part = parts[static_cast<std::size_t>(regions.region_of(face.unseen))];
    const double behind = face_area * depth_behind(view, face, free_path);
    const LastLook::Open* open = looked_for ? options.last_look->find(face.unseen) : nullptr;
    const bool viewable = looked_for ? open != nullptr : reachable[face.seen] != 0;
    part.has_face = true;
    part.reachable = part.reachable || viewable;
    part.rim += face_area * h;
    const bool stubborn = looked_for && std::binary_search(options.last_look->stubborn.begin(), options.last_look->stubborn.end(), face.unseen);
    // Off the walls and deep, beside what was seen through something narrow: nobody can tell how far it goes on.
    const bool through = looked_for && air[face.seen] == 0 && face.known_distance >= 0.75 * h && depth_behind(view, face, 2.0 * h) >= 2.0 * h;
    part.doubtful = part.doubtful || viewable || through;
    if (stubborn) (through ? part.open : part.stuck) += behind;
    if (viewable) part.open += behind * face.probability;
  }
  for (const LastLook* look : {options.last_look, options.squeezed}) {
    if (look == nullptr || !look->asked) continue;
    for (const LastLook::Open& open : look->open) {
      Part<Dim>& part = parts[static_cast<std::size_t>(regions.region_of(open.unseen))];
      // Gaps of the surface mostly are places between the rays; where light got through one, there is a glimpse.
      if (!open.slit) (look == options.last_look ? part.doubtful : part.squeezed) = true;
      if (look == options.last_look && part.viewer == kNoNode) part.viewer = open.viewer;
    }
  }
}

/// What a part adds to the volume that can be seen [m^Dim].
struct Share {
  double least = 0.0, expected = 0.0, most = 0.0;
};

template <int Dim>
Share share_of(const Part<Dim>& part, double h) {
  const double cell = cell_measure<Dim>(h, Dim);
  const double all = part.clear * cell;
  const bool entered = part.glimpsed >= kGlimpses;
  Share share;
  share.least = 0.25 * std::min(all, part.glimpsed * cell);  // A ray through a cell does not show all of it.
  share.most = part.doubtful || part.squeezed || entered ? all : std::min(all, part.rim + 2.0 * part.stuck);
  share.expected = std::min(all, part.open + 0.1 * part.stuck);
  // Light gets in where no opening is known: as much as not may be seen that way.
  if (entered) share.expected = std::max(share.expected, std::min(0.5 * (share.least + share.most), 4.0 * part.glimpsed * cell));
  // A passage the lattice is too coarse for leads to where nobody has looked.
  if (part.squeezed && !part.doubtful && part.deepest >= 2.0 * h) share.expected = share.most;
  return share;
}

template <int Dim>
std::string reason_of(const Part<Dim>& part, double h, bool far) {
  if (!part.has_face) return part.glimpsed > 0.0 ? "too fine for the lattice" : "enclosed";
  if (part.deepest < h) return "too fine for the lattice";
  if (!part.reachable) return far ? "beyond range" : "no reachable view";
  return "below the threshold";
}

/// Seen nodes farther than h from the known surface.
template <int Dim>
std::size_t clear_nodes(const BeliefView<Dim>& view) {
  return parallel_reduce(
      view.state.values.size(), std::size_t{1} << 16, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i)
          count += view.seen(i) && static_cast<double>(view.known_distance[i]) > view.window().spacing ? 1 : 0;
        return count;
      },
      [](std::size_t& sum, std::size_t part) { sum += part; });
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
                    const AssessOptions<Dim>& options) {
  const Grid<Dim>& grid = view.window();
  const double h = grid.spacing, cell = cell_measure<Dim>(h, Dim);
  const Regions<Dim> regions(grid, [&](std::size_t first, std::span<std::uint8_t> row) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = view.state[first + k] == NodeState::unseen;
  });
  std::vector<Part<Dim>> parts = parts_of(view, regions);
  add_faces(view, faces, reachable, regions, options, parts);
  if (options.glimpsed != nullptr)
    options.glimpsed->for_each(view.state, [&](std::size_t node) {
      const bool clear = static_cast<double>(view.known_distance[node]) > 1.5 * h, deep = static_cast<double>(view.psi[node]) < -2.0 * h;
      if (clear && deep) parts[static_cast<std::size_t>(regions.region_of(node))].glimpsed += 1.0;
    });

  const Box<Dim> ground = bounds_of(reachable);
  double open = 0.0, most = 0.0, least = 0.0;
  Verdict<Dim> verdict;
  for (const Part<Dim>& part : parts) {
    const double volume = part.nodes * cell;
    const Share share = share_of(part, h);
    open += share.expected;
    most += share.most;
    least += share.least;
    verdict.unseen_volume += volume;
    if (volume < options.least_volume) continue;
    UnseenRegion<Dim> region;
    region.volume = volume;
    region.may_open = share.expected;
    region.box = {grid.position(part.low).array() - 0.5 * h, grid.position(part.high).array() + 0.5 * h};
    region.reason = reason_of(part, h, gap(region.box, ground) > options.max_range);
    if (part.viewer != kNoNode) region.open_from = grid.position(part.viewer);
    verdict.unseen.push_back(region);
  }
  std::stable_sort(verdict.unseen.begin(), verdict.unseen.end(), [](const auto& a, const auto& b) { return a.volume > b.volume; });

  const double seen = static_cast<double>(clear_nodes(view)) * cell;
  const auto share = [&](double rest) { return seen + rest > 0.0 ? seen / (seen + rest) : 0.0; };
  verdict.seen_fraction = share(open);
  verdict.seen_low = share(most + kLattice * seen);
  verdict.seen_high = std::min(1.0, share(least) + kLattice);
  return verdict;
}

template std::size_t seen_nodes<2>(const BeliefView<2>&);
template std::size_t seen_nodes<3>(const BeliefView<3>&);
template Verdict<2> assess<2>(const BeliefView<2>&, std::span<const BoundaryFace<2>>, const Field<2, std::uint8_t>&, const AssessOptions<2>&);
template Verdict<3> assess<3>(const BeliefView<3>&, std::span<const BoundaryFace<3>>, const Field<3, std::uint8_t>&, const AssessOptions<3>&);

}  // namespace vantage
