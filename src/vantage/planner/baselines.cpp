// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/baselines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "vantage/field/distance.h"
#include "vantage/field/fast_marching.h"

namespace vantage {
namespace {

/// Calls f with every node of `grid` at most one step away along each axis, the node itself too.
template <int Dim, class F>
void for_surrounding(const Grid<Dim>& grid, const Index<Dim>& center, F&& f) {
  int all = 1;
  for (int a = 0; a < Dim; ++a) all *= 3;
  for (int code = 0; code < all; ++code) {
    Index<Dim> node = center;
    for (int a = 0, rest = code; a < Dim; ++a, rest /= 3) node[a] += rest % 3 - 1;
    if (grid.inside(node)) f(grid.linear(node));
  }
}

}  // namespace

template <int Dim>
std::vector<BoundaryFace<Dim>> frontier_faces(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces) {
  double least = kInfinity;
  for (const BoundaryFace<Dim>& face : faces)
    if (face.probability > 0.0) least = std::min(least, face.probability >= kFrontierProbability ? 0.0 : face.probability);
  least = least == 0.0 ? kFrontierProbability : least;
  std::map<std::size_t, int> faces_at;  // Per unseen node.
  for (const BoundaryFace<Dim>& face : faces)
    if (face.probability >= least) ++faces_at[face.unseen];
  std::map<std::size_t, int> group_size;
  std::vector<std::size_t> group;
  for (const auto& [first, count] : faces_at) {
    if (group_size.contains(first)) continue;
    group.assign(1, first);
    group_size[first] = 0;
    int size = 0;
    for (std::size_t k = 0; k < group.size(); ++k) {
      size += faces_at[group[k]];
      for_surrounding(view.window(), view.window().local(group[k]), [&](std::size_t next) {
        if (faces_at.contains(next) && group_size.try_emplace(next, 0).second) group.push_back(next);
      });
    }
    for (const std::size_t node : group) group_size[node] = size;
  }
  const bool any_large = std::any_of(group_size.begin(), group_size.end(), [](const auto& entry) { return entry.second >= Dim; });
  std::vector<BoundaryFace<Dim>> frontier;
  for (const BoundaryFace<Dim>& face : faces)
    if (face.probability >= least && (!any_large || group_size[face.unseen] >= Dim)) frontier.push_back(face);
  return frontier;
}

template <int Dim>
std::vector<FrontierPlace> frontier_places(const Field<Dim, std::uint8_t>& reachable, std::span<const BoundaryFace<Dim>> frontier,
                                           std::span<const Vec<Dim>> visited, double reach) {
  const Grid<Dim>& grid = reachable.window;
  if (frontier.empty() || visited.empty()) return {};
  Field<Dim, std::uint8_t> beside(grid);
  for (const BoundaryFace<Dim>& face : frontier) beside[face.seen] = 1;
  const Field<Dim> distance = distance_to_set(beside, grid.bounds().size().norm() + grid.spacing);
  std::vector<Seed> home;
  for_surrounding(grid, grid.nearest(visited.back()), [&](std::size_t node) {
    if (reachable[node] != 0) home.emplace_back(node, static_cast<float>((grid.position(node) - visited.back()).norm()));
  });
  const Field<Dim> walk = fast_march(reachable, std::span<const Seed>(home));
  const auto fresh = [&](std::size_t node) {
    const Vec<Dim> p = grid.position(node);
    return std::isfinite(walk[node]) &&
           std::none_of(visited.begin(), visited.end(), [&](const Vec<Dim>& v) { return (p - v).norm() < 2.0 * grid.spacing; });
  };
  double least = kInfinity;
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (static_cast<double>(distance[i]) < least && reachable[i] != 0 && fresh(i)) least = static_cast<double>(distance[i]);
  std::vector<FrontierPlace> places;
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (static_cast<double>(distance[i]) <= std::max(reach, least) && reachable[i] != 0 && fresh(i))
      places.push_back({i, static_cast<double>(walk[i])});
  std::sort(places.begin(), places.end(),
            [](const FrontierPlace& a, const FrontierPlace& b) { return std::tuple(a.walk, a.node) < std::tuple(b.walk, b.node); });
  return places;
}

template <int Dim>
double frontier_count(std::span<const BoundaryFace<Dim>> frontier, const RayMarch<Dim>& rays, const Vec<Dim>& z, double max_range) {
  constexpr std::size_t kMost = 1000;
  const std::size_t stride = frontier.size() / kMost + 1;
  std::size_t count = 0;
  for (std::size_t i = 0; i < frontier.size(); i += stride) {
    const BoundaryFace<Dim>& face = frontier[i];
    if ((z - face.center).norm() <= max_range && rays.line_of_sight(z, face.center, 1.5 * rays.spacing())) count += stride;
  }
  return static_cast<double>(count);
}

#define VANTAGE_INSTANTIATE(D)                                                                                                                     \
  template std::vector<BoundaryFace<D>> frontier_faces<D>(const BeliefView<D>&, std::span<const BoundaryFace<D>>);                                 \
  template std::vector<FrontierPlace> frontier_places<D>(const Field<D, std::uint8_t>&, std::span<const BoundaryFace<D>>, std::span<const Vec<D>>, \
                                                         double);                                                                                  \
  template double frontier_count<D>(std::span<const BoundaryFace<D>>, const RayMarch<D>&, const Vec<D>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
