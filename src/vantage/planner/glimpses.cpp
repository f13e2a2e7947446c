// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/glimpses.h"

#include "vantage/base/parallel.h"

namespace vantage {

template <int Dim>
  requires SpatialDim<Dim>
void Glimpses<Dim>::note(const BeliefView<Dim>& view, const Scan<Dim>& scan) {
  const Grid<Dim>& grid = view.window();
  const double h = grid.spacing;
  const std::vector<Vec<Dim>> rays = directions<Dim>(scan.pattern);
  const Box<Dim> bounds = grid.bounds();
  const auto unseen_at = [&](const Vec<Dim>& p) {
    const Index<Dim> node = grid.nearest(p);
    return grid.inside(node) && view.state.at(node) == NodeState::unseen ? grid.linear(node) : static_cast<std::size_t>(-1);
  };
  const auto along = [&](std::size_t begin, std::size_t end) {
    std::vector<std::size_t> found;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isnan(scan.ranges[i])) continue;
      const Vec<Dim> way = scan.world_from_sensor * rays[i];
      double free = std::min(static_cast<double>(scan.ranges[i]), scan.pattern.max_range);
      for (int a = 0; a < Dim; ++a) {  // Up to where the ray leaves the lattice.
        if (way[a] > 0.0) free = std::min(free, (bounds.high[a] - scan.origin[a]) / way[a]);
        if (way[a] < 0.0) free = std::min(free, (bounds.low[a] - scan.origin[a]) / way[a]);
      }
      for (double t = free - 1.5 * h; t > 0.0; t -= 0.5 * h) {
        const std::size_t node = unseen_at(scan.origin + t * way);
        if (node == static_cast<std::size_t>(-1)) break;
        if (found.empty() || found.back() != node) found.push_back(node);
      }
    }
    return found;
  };
  const auto join = [](std::vector<std::size_t>& all, std::vector<std::size_t> part) { all.insert(all.end(), part.begin(), part.end()); };
  join(nodes_, parallel_reduce(rays.size(), 4096, std::vector<std::size_t>{}, along, join));
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

template class Glimpses<2>;
template class Glimpses<3>;

}  // namespace vantage
