// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/candidates.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/field/fast_marching.h"
#include "vantage/field/stencil.h"

namespace vantage {
namespace {

constexpr int kBlock = 4;  // Cells along a block's side.

template <int Dim>
std::uint64_t block_code(const Index<Dim>& block) {
  std::uint64_t code = 0;
  for (int a = 0; a < Dim; ++a) code = code << 21 | static_cast<std::uint64_t>(block[a] + 16);
  return code;
}

/// Nodes grouped by block.
template <int Dim>
class Blocks {
 public:
  Blocks(std::span<const std::size_t> nodes, const Grid<Dim>& grid) : grid_(grid) {
    for (const std::size_t node : nodes) of_[block_code<Dim>(grid.local(node) / kBlock)].push_back(node);
  }
  /// A random node of a block; none if it is empty.
  [[nodiscard]] const std::size_t* pick(const Index<Dim>& block, Random& random) const {
    const auto found = of_.find(block_code<Dim>(block));
    return found == of_.end() ? nullptr : &found->second[random.below(found->second.size())];
  }
  [[nodiscard]] Index<Dim> block_of(std::size_t node) const { return grid_.local(node) / kBlock; }

 private:
  const Grid<Dim>& grid_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> of_;
};

/// The faces to aim at: by probability with some chance, at most two a block and 600 in all.
template <int Dim>
std::vector<const BoundaryFace<Dim>*> targets(std::span<const BoundaryFace<Dim>> faces, const Blocks<Dim>& blocks, Random& random) {
  constexpr std::size_t kMost = 600;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (faces[i].probability > 0.0) order.emplace_back(-faces[i].probability * random.uniform(0.5, 1.0), i);
  std::sort(order.begin(), order.end());
  std::unordered_map<std::uint64_t, int> taken;
  std::vector<const BoundaryFace<Dim>*> chosen;
  for (const auto& [score, i] : order) {
    if (taken[block_code<Dim>(blocks.block_of(faces[i].unseen))]++ >= 2) continue;
    chosen.push_back(&faces[i]);
    if (chosen.size() == kMost) break;
  }
  return chosen;
}

/// Up to two nodes that look at the face from its seen side, sought in ever wider rings.
template <int Dim>
std::vector<std::size_t> viewers(const BoundaryFace<Dim>& face, const Blocks<Dim>& blocks, const RayMarch<Dim>& rays, const Grid<Dim>& grid,
                                 Random& random) {
  constexpr int kTries = 12;
  std::vector<std::size_t> found;
  const Index<Dim> center = blocks.block_of(face.seen);
  for (const int radius : {1, 2, 4, 8}) {
    for (int attempt = 0; attempt < kTries; ++attempt) {
      Index<Dim> block = center;
      for (int a = 0; a < Dim; ++a) block[a] += static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(2 * radius + 1))) - radius;
      if ((block.array() < 0).any()) continue;
      const std::size_t* node = blocks.pick(block, random);
      if (node == nullptr) continue;
      const Vec<Dim> z = grid.position(*node), offset = z - face.center;
      if (offset.dot(face.step()) < 0.15 * offset.norm() || !rays.line_of_sight(z, face.center, 1.5 * grid.spacing)) continue;
      found.push_back(*node);
      if (found.size() == 2) return found;
    }
  }
  return found;
}

}  // namespace

template <int Dim>
Field<Dim, std::uint8_t> reachable_nodes(const BeliefView<Dim>& view, const Vec<Dim>& from, double clearance) {
  const Grid<Dim>& grid = view.window();
  const Index<Dim> home = grid.nearest(from);
  const bool cramped = grid.inside(home) && static_cast<double>(view.known_distance.at(home)) < clearance;
  const double near = cramped ? 2.0 * clearance + 2.0 * grid.spacing : 0.0;
  const auto passable = [&](std::size_t node) {
    return view.seen(node) && (static_cast<double>(view.known_distance[node]) >= clearance || (grid.position(node) - from).norm() <= near);
  };
  Field<Dim, std::uint8_t> reached(grid);
  std::vector<std::size_t> front;
  const auto enter = [&](std::size_t node) {
    if (reached[node] != 0 || !passable(node)) return;
    reached[node] = 1;
    front.push_back(node);
  };
  // Every seen node beside the scanner starts the flood.
  int corners = 1;
  for (int a = 0; a < Dim; ++a) corners *= 3;
  for (int code = 0; code < corners; ++code) {
    Index<Dim> node = home;
    for (int a = 0, rest = code; a < Dim; ++a, rest /= 3) node[a] += rest % 3 - 1;
    if (grid.inside(node)) enter(grid.linear(node));
  }
  while (!front.empty()) {
    const std::size_t node = front.back();
    front.pop_back();
    const Index<Dim> here = grid.local(node);
    for (int a = 0; a < Dim; ++a) {
      if (here[a] > 0) enter(node - grid.stride(a));
      if (here[a] + 1 < grid.extent[a]) enter(node + grid.stride(a));
    }
  }
  return reached;
}

template <int Dim>
std::vector<std::size_t> medial_nodes(const BeliefView<Dim>& view, const Field<Dim, std::uint8_t>& reachable, std::span<const Vec<Dim>> visited,
                                      const PlannerOptions& options) {
  const Grid<Dim>& grid = view.window();
  const double h = grid.spacing, sign = options.printed_curvature ? 1.0 : -1.0;
  const double off_surface = std::max(options.clearance, h);
  const auto fresh = [&](std::size_t node) {
    const Vec<Dim> p = grid.position(node);
    return std::none_of(visited.begin(), visited.end(), [&](const Vec<Dim>& v) { return (p - v).norm() < 2.0 * h; });
  };
  using Nodes = std::vector<std::size_t>;
  const auto gather = [&](auto&& wanted) {
    return parallel_reduce(
        grid.size(), std::size_t{1} << 15, Nodes{},
        [&](std::size_t begin, std::size_t end) {
          Nodes part;
          for (std::size_t i = begin; i < end; ++i)
            if (reachable[i] != 0 && wanted(i) && fresh(i)) part.push_back(i);
          return part;
        },
        [](Nodes& all, Nodes part) { all.insert(all.end(), part.begin(), part.end()); });
  };
  Nodes medial = gather([&](std::size_t i) {
    return static_cast<double>(view.psi[i]) > 0.6 * h && static_cast<double>(view.known_distance[i]) >= off_surface &&
           sign * laplacian(view.psi, grid.local(i)) > options.curvature / h;
  });
  return medial.empty() ? gather([](std::size_t) { return true; }) : medial;
}

template <int Dim>
std::vector<std::size_t> choose_candidates(std::span<const std::size_t> nodes, std::span<const BoundaryFace<Dim>> faces, const RayMarch<Dim>& rays,
                                           const Grid<Dim>& grid, std::size_t limit, std::uint64_t seed) {
  std::vector<std::size_t> chosen(nodes.begin(), nodes.end());
  if (nodes.size() <= limit) return chosen;
  Random random(seed);
  chosen.clear();
  for (std::size_t k = 0; k < limit * 2 / 5; ++k) chosen.push_back(nodes[random.below(nodes.size())]);
  const Blocks<Dim> blocks(nodes, grid);
  for (const BoundaryFace<Dim>* face : targets(faces, blocks, random)) {
    for (const std::size_t node : viewers(*face, blocks, rays, grid, random)) chosen.push_back(node);
    if (chosen.size() >= limit) break;
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

template <int Dim>
std::vector<Vec<Dim>> safe_path(const Field<Dim, std::uint8_t>& reachable, std::size_t target, const Vec<Dim>& here) {
  // The node beside the scanner that the flood started from.
  const Grid<Dim>& grid = reachable.window;
  std::size_t home = target;
  double nearest = kInfinity;
  const Index<Dim> center = grid.nearest(here);
  for (int code = 0, all = 1 << (2 * Dim); code < all; ++code) {
    Index<Dim> node = center;
    for (int a = 0; a < Dim; ++a) node[a] += (code >> (2 * a) & 3) - 1;
    if (!grid.inside(node) || reachable.at(node) == 0) continue;
    const double distance = (grid.position(node) - here).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    home = grid.linear(node);
  }
  const Seed seed{target, 0.0F};
  std::vector<Vec<Dim>> path = descend(fast_march_to(reachable, std::span(&seed, 1), home), home);
  path.insert(path.begin(), here);
  return path;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                               \
  template std::vector<Vec<D>> safe_path<D>(const Field<D, std::uint8_t>&, std::size_t, const Vec<D>&);                                      \
  template Field<D, std::uint8_t> reachable_nodes<D>(const BeliefView<D>&, const Vec<D>&, double);                                           \
  template std::vector<std::size_t> medial_nodes<D>(const BeliefView<D>&, const Field<D, std::uint8_t>&, std::span<const Vec<D>>,            \
                                                    const PlannerOptions&);                                                                  \
  template std::vector<std::size_t> choose_candidates<D>(std::span<const std::size_t>, std::span<const BoundaryFace<D>>, const RayMarch<D>&, \
                                                         const Grid<D>&, std::size_t, std::uint64_t);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
