// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/coverage.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 14;

/// How surely an explorer that looks there calls the node seen.
int clarity(const Truth& truth) {
  if (!truth.inside || !truth.visible) return 0;
  return truth.blurred ? 1 : truth.near ? 2 : 3;
}

/// The node of a run's lattice that decides whether node `i` of the reference is seen: global index at the spacing h.
template <int Dim>
Index<Dim> deciding_node(const Reference<Dim>& reference, const Index<Dim>& i) {
  const Grid<Dim>& grid = reference.nodes.window;
  const Index<Dim> odd = (grid.first + i).unaryExpr([](std::int32_t v) { return v & 1; });
  const Grid<Dim> choices{1.0, Index<Dim>(i - odd), Index<Dim>(odd.array() + 1)};  // One or two along each axis.
  Index<Dim> chosen = choices.first;
  int best = -1;
  for (std::size_t k = 0; k < choices.size() && best < 3; ++k) {
    const Index<Dim> node = choices.first + 2 * choices.local(k);
    const int now = grid.inside(node) ? clarity(reference.nodes.at(node)) : -1;
    if (now <= best) continue;
    best = now;
    chosen = node;
  }
  return (grid.first + chosen).unaryExpr([](std::int32_t v) { return v / 2; });
}

template <int Dim>
bool called_seen(const Field<Dim, NodeState>& explored, const Index<Dim>& global) {
  const Index<Dim> local = global - explored.window.first;
  return explored.window.inside(local) && explored.at(local) == NodeState::seen;
}

/// No reachable place sees this node of a run's lattice.
template <int Dim>
bool hidden(const Reference<Dim>& reference, const Index<Dim>& global) {
  const Index<Dim> local = 2 * global - reference.nodes.window.first;
  return reference.nodes.window.inside(local) && reference.nodes.at(local).inside && !reference.nodes.at(local).visible;
}

}  // namespace

template <int Dim>
Coverage coverage(const Reference<Dim>& reference, const Field<Dim, NodeState>& explored) {
  const Grid<Dim>&fine = reference.nodes.window, &coarse = explored.window;
  require(coarse.spacing == reference.options.voxel,
          fmt::format("audit: explored lattice of {} m: must be the reference's {} m", coarse.spacing, reference.options.voxel));
  struct Count {
    std::size_t all = 0, narrow = 0;
  };
  const Count seen = parallel_reduce(
      fine.size(), kChunk, Count{},
      [&](std::size_t begin, std::size_t end) {
        Count n;
        for (std::size_t i = begin; i < end; ++i) {
          const Truth& truth = reference.nodes[i];
          if (!truth.counts() || !called_seen(explored, deciding_node(reference, fine.local(i)))) continue;
          ++n.all;
          n.narrow += truth.narrow ? 1 : 0;
        }
        return n;
      },
      [](Count& total, const Count& part) {
        total.all += part.all;
        total.narrow += part.narrow;
      });
  const std::size_t wrong = parallel_reduce<std::size_t>(
      coarse.size(), kChunk, 0,
      [&](std::size_t begin, std::size_t end) {
        std::size_t n = 0;
        for (std::size_t i = begin; i < end; ++i)
          n += explored[i] == NodeState::seen && hidden<Dim>(reference, coarse.local(i) + coarse.first) ? 1 : 0;
        return n;
      },
      [](std::size_t& total, std::size_t part) { total += part; });
  const auto share = [](std::size_t part, std::size_t all) { return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 1.0; };
  return {share(seen.all, reference.counted), share(seen.all - seen.narrow, reference.counted - reference.narrow),
          static_cast<double>(wrong) * reference.node_volume() * (1 << Dim)};
}

template <int Dim>
double falsely_hidden(const Reference<Dim>& reference, const RayCaster<Dim>& truth, const Field<Dim, NodeState>& explored,
                      std::span<const Vec<Dim>> scans, std::size_t nodes) {
  const Grid<Dim>& grid = reference.nodes.window;
  std::vector<std::size_t> counting;
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (reference.nodes[i].counts()) counting.push_back(i);
  const std::size_t looked = std::min(nodes, counting.size());
  Random random(1);
  for (std::size_t k = 0; k < looked; ++k) {  // One from each of equally long stretches.
    const std::size_t begin = k * counting.size() / looked, end = (k + 1) * counting.size() / looked;
    counting[k] = counting[begin + random.below(end - begin)];
  }
  std::vector<std::uint8_t> hidden(looked);
  parallel_for(looked, 64, [&](std::size_t k) {
    if (called_seen(explored, deciding_node(reference, grid.local(counting[k])))) return;
    const Vec<Dim> place = grid.position(counting[k]);
    hidden[k] = std::any_of(scans.begin(), scans.end(),
                            [&](const Vec<Dim>& from) { return (place - from).norm() <= reference.options.range && in_sight(truth, from, place); });
  });
  const auto count = std::count(hidden.begin(), hidden.end(), 1);
  return reference.volume() * static_cast<double>(count) / static_cast<double>(looked);
}

template Coverage coverage<2>(const Reference<2>&, const Field<2, NodeState>&);
template Coverage coverage<3>(const Reference<3>&, const Field<3, NodeState>&);
template double falsely_hidden<2>(const Reference<2>&, const RayCaster<2>&, const Field<2, NodeState>&, std::span<const Vec<2>>, std::size_t);
template double falsely_hidden<3>(const Reference<3>&, const RayCaster<3>&, const Field<3, NodeState>&, std::span<const Vec<3>>, std::size_t);

}  // namespace vantage
