// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/candidates.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/planner/regions.h"

namespace vantage {
namespace {

constexpr int kBlock = 4;  // Cells along a block's side.

/// Nodes grouped by block, in their order.
template <int Dim>
class Blocks {
 public:
  Blocks(std::span<const std::size_t> nodes, const Grid<Dim>& grid) : grid_(grid), blocks_(grid), nodes_(nodes.size()) {
    blocks_.extent = (grid.extent.array() + (kBlock - 1)) / kBlock;
    std::vector<std::uint32_t> block_of_node;
    block_of_node.reserve(nodes.size());
    first_.assign(blocks_.size() + 1, 0);
    for (const std::size_t node : nodes) {
      block_of_node.push_back(static_cast<std::uint32_t>(number(block_of(node))));
      ++first_[block_of_node.back() + 1];
    }
    for (std::size_t b = 0; b < blocks_.size(); ++b) first_[b + 1] += first_[b];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes_[next[block_of_node[i]]++] = nodes[i];
  }
  /// A random node of a block; none if it is empty or outside.
  [[nodiscard]] const std::size_t* pick(const Index<Dim>& block, Random& random) const {
    if (!blocks_.inside(block)) return nullptr;
    const std::size_t first = first_[number(block)], count = first_[number(block) + 1] - first;
    return count == 0 ? nullptr : &nodes_[first + random.below(count)];
  }
  [[nodiscard]] Index<Dim> block_of(std::size_t node) const { return grid_.local(node) / kBlock; }
  [[nodiscard]] std::size_t number(const Index<Dim>& block) const { return blocks_.linear(block); }
  [[nodiscard]] std::size_t count() const { return blocks_.size(); }

 private:
  Grid<Dim> grid_, blocks_;
  std::vector<std::uint32_t> first_;
  std::vector<std::size_t> nodes_;
};

/// The faces to aim at: by probability with some chance, at most two a block and 600 in all.
template <int Dim>
std::vector<const BoundaryFace<Dim>*> targets(std::span<const BoundaryFace<Dim>> faces, const Blocks<Dim>& blocks, Random& random) {
  constexpr std::size_t kMost = 600;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (faces[i].probability > 0.0) order.emplace_back(-faces[i].probability * random.uniform(0.5, 1.0), i);
  std::sort(order.begin(), order.end());
  std::vector<std::uint8_t> taken(blocks.count());
  std::vector<const BoundaryFace<Dim>*> chosen;
  for (const auto& [score, i] : order) {
    std::uint8_t& of_block = taken[blocks.number(blocks.block_of(faces[i].unseen))];
    if (of_block == 2) continue;
    ++of_block;
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

/// laplacian() of field/stencil.h with the steps at hand.
template <int Dim>
struct Curvature {
  explicit Curvature(const Grid<Dim>& window) : grid(window) {
    for (int a = 0; a < Dim; ++a) stride[static_cast<std::size_t>(a)] = grid.stride(a);
  }
  [[nodiscard]] double operator()(const Field<Dim>& field, std::size_t i, const Index<Dim>& node) const {
    const double twice = 2.0 * static_cast<double>(field[i]);
    double sum = 0.0;
    for (int a = 0; a < Dim; ++a) {
      if (node[a] == 0 || node[a] + 1 == grid.extent[a]) continue;
      const std::size_t step = stride[static_cast<std::size_t>(a)];
      sum += static_cast<double>(field[i - step]) + static_cast<double>(field[i + step]) - twice;
    }
    return sum / (grid.spacing * grid.spacing);
  }
  Grid<Dim> grid;
  std::array<std::size_t, Dim> stride{};
};

}  // namespace

template <int Dim>
std::size_t first_node(const BeliefView<Dim>& view, const Vec<Dim>& from, const std::function<bool(std::size_t)>& allowed) {
  const Grid<Dim>& grid = view.window();
  const Index<Dim> home = grid.nearest(from);
  const double free = grid.inside(home) ? static_cast<double>(view.known_distance.at(home)) - (grid.position(home) - from).norm() : 0.0;
  std::size_t best = kNoNode;
  std::pair least{true, kInfinity};  // Whether a surface may stand between, and the distance.
  int corners = 1;
  for (int a = 0; a < Dim; ++a) corners *= 3;
  for (int code = 0; code < corners; ++code) {
    Index<Dim> node = home;
    for (int a = 0, rest = code; a < Dim; ++a, rest /= 3) node[a] += rest % 3 - 1;
    if (!grid.inside(node) || !allowed(grid.linear(node))) continue;
    const double distance = (grid.position(node) - from).norm();
    const std::pair rank{free + static_cast<double>(view.known_distance.at(node)) <= distance, distance};
    if (rank < least) least = rank, best = grid.linear(node);
  }
  return best;
}

template <int Dim>
Field<Dim, std::uint8_t> reachable_nodes(const BeliefView<Dim>& view, const Vec<Dim>& from, double clearance) {
  const Grid<Dim>& grid = view.window();
  const Index<Dim> home = grid.nearest(from);
  const bool cramped = grid.inside(home) && static_cast<double>(view.known_distance.at(home)) < clearance;
  const double near = cramped ? 2.0 * clearance + 2.0 * grid.spacing : 0.0;
  const Regions<Dim> passable(grid, [&](std::size_t first, std::span<std::uint8_t> row) {
    for (std::size_t k = 0; k < row.size(); ++k)
      row[k] = view.seen(first + k) &&
               (static_cast<double>(view.known_distance[first + k]) >= clearance || (cramped && (grid.position(first + k) - from).norm() <= near));
  });
  const std::size_t first = first_node<Dim>(view, from, [&](std::size_t node) { return passable.region_of(node) >= 0; });
  Field<Dim, std::uint8_t> nodes(grid);
  if (first == kNoNode) return nodes;
  const std::int32_t reached = passable.region_of(first);
  parallel_for(passable.rows(), 256, [&](std::size_t r) {
    std::uint8_t* row = nodes.values.data() + r * passable.row_length();
    for (const auto& run : passable.row(r))
      if (run.region == reached) std::fill(row + run.begin, row + run.end, std::uint8_t{1});
  });
  return nodes;
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
  const auto length = static_cast<std::size_t>(grid.extent[0]);
  const auto gather = [&](auto&& wanted) {
    return parallel_reduce(
        grid.size() / length, 64, Nodes{},
        [&](std::size_t begin, std::size_t end) {
          Nodes part;
          for (std::size_t r = begin; r < end; ++r) {
            const Index<Dim> first = grid.local(r * length);
            for (std::size_t k = 0; k < length; ++k) {
              const std::size_t i = r * length + k;
              if (reachable[i] == 0) continue;
              Index<Dim> node = first;
              node[0] = static_cast<std::int32_t>(k);
              if (wanted(i, node) && fresh(i)) part.push_back(i);
            }
          }
          return part;
        },
        [](Nodes& all, Nodes part) { all.insert(all.end(), part.begin(), part.end()); });
  };
  const auto least_psi = 0.6 * h, least_curvature = options.curvature / h;
  const Curvature<Dim> curvature(grid);
  Nodes medial = gather([&](std::size_t i, const Index<Dim>& node) {
    return static_cast<double>(view.psi[i]) > least_psi && static_cast<double>(view.known_distance[i]) >= off_surface &&
           sign * curvature(view.psi, i, node) > least_curvature;
  });
  return medial.empty() ? gather([](std::size_t, const Index<Dim>&) { return true; }) : medial;
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

#define VANTAGE_INSTANTIATE(D)                                                                                                               \
  template std::size_t first_node<D>(const BeliefView<D>&, const Vec<D>&, const std::function<bool(std::size_t)>&);                          \
  template Field<D, std::uint8_t> reachable_nodes<D>(const BeliefView<D>&, const Vec<D>&, double);                                           \
  template std::vector<std::size_t> medial_nodes<D>(const BeliefView<D>&, const Field<D, std::uint8_t>&, std::span<const Vec<D>>,            \
                                                    const PlannerOptions&);                                                                  \
  template std::vector<std::size_t> choose_candidates<D>(std::span<const std::size_t>, std::span<const BoundaryFace<D>>, const RayMarch<D>&, \
                                                         const Grid<D>&, std::size_t, std::uint64_t);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
