// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/ways.h"

#include <fmt/format.h>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// The node among `nodes` nearest to p.
template <int Dim>
std::size_t nearest_of(const Field<Dim, std::uint8_t>& nodes, const Vec<Dim>& p) {
  std::size_t best = nodes.values.size();
  double least = kInfinity;
  for (std::size_t i = 0; i < nodes.values.size(); ++i) {
    const double distance = nodes[i] != 0 ? (nodes.window.position(i) - p).squaredNorm() : kInfinity;
    if (distance < least) least = distance, best = i;
  }
  return best;
}

/// What face steps join to one node.
template <int Dim>
Field<Dim, std::uint8_t> joined_to(const Field<Dim, std::uint8_t>& nodes, std::size_t first) {
  Field<Dim, std::uint8_t> joined(nodes.window);
  std::vector<std::size_t> queue{first};
  joined[first] = 1;
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (int side = 0; side < 2 * Dim; ++side) {
      Index<Dim> next = nodes.window.local(queue[k]);
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if (!nodes.window.inside(next) || nodes.at(next) == 0 || joined.at(next) != 0) continue;
      joined.at(next) = 1;
      queue.push_back(nodes.window.linear(next));
    }
  return joined;
}

}  // namespace

template <int Dim>
bool is_high(const RayCaster<Dim>& truth, const Vec<Dim>& p, double height, double slack) {
  if (height <= 0.0) return true;
  const double drop = truth.cast(p, -Vec<Dim>::Unit(Dim - 1), height + slack).range;
  return drop >= height - slack && drop < height + slack;
}

void require_height(bool holds, const SurveyOptions& options) {
  require(holds, fmt::format("no reachable place is {} m above what is below it", options.height), "survey.height");
}

template <int Dim>
Ways<Dim> find_ways(const RayCaster<Dim>& truth, const Reference<Dim>& reference, const Vec<Dim>& start, const SurveyOptions& options) {
  const Grid<Dim>& grid = reference.nodes.window;
  Field<Dim, std::uint8_t> nodes(grid);
  parallel_for(grid.size(), 1024, [&](std::size_t i) {
    nodes[i] = reference.nodes[i].reachable && is_high(truth, grid.position(i), options.height, grid.spacing) ? 1 : 0;
  });
  if (options.height <= 0.0) return {nodes, start};
  const double drop = truth.cast(start, -Vec<Dim>::Unit(Dim - 1)).range;
  const Vec<Dim> foot = start - (drop < kInfinity ? drop - options.height : 0.0) * Vec<Dim>::Unit(Dim - 1);
  const std::size_t first = nearest_of<Dim>(nodes, foot);
  require_height(first < grid.size(), options);
  return {joined_to(nodes, first), grid.position(first)};
}

#define VANTAGE_INSTANTIATE(D)                                                  \
  template bool is_high<D>(const RayCaster<D>&, const Vec<D>&, double, double); \
  template Ways<D> find_ways<D>(const RayCaster<D>&, const Reference<D>&, const Vec<D>&, const SurveyOptions&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
