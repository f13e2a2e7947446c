// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "vantage/base/parallel.h"
#include "vantage/field/distance.h"
#include "vantage/field/narrow_band.h"

namespace vantage {
namespace {

/// Distances within `reach` of each patch by geometry; `owner` remembers the patch.
template <int Dim>
struct Band {
  Field<Dim> distance;
  Field<Dim, std::int32_t> owner;
};

/// Nodes of `window` in `box`: [low, high), empty if none.
template <int Dim>
std::pair<Index<Dim>, Index<Dim>> nodes_in(const Grid<Dim>& window, const Box<Dim>& box) {
  Index<Dim> low, high;
  for (int a = 0; a < Dim; ++a) {
    low[a] = std::max(static_cast<std::int32_t>(std::ceil(std::max(box.low[a] / window.spacing, -2e9))) - window.first[a], 0);
    high[a] = std::min(static_cast<std::int32_t>(std::floor(std::min(box.high[a] / window.spacing, 2e9))) - window.first[a] + 1, window.extent[a]);
  }
  return {low, high};
}

/// Calls f(local index, linear index) over the nodes of [low, high), axis 0 fastest.
template <int Dim, class F>
void for_nodes(const Grid<Dim>& window, const Index<Dim>& low, const Index<Dim>& high, F&& f) {
  if ((low.array() >= high.array()).any()) return;
  Index<Dim> i = low;
  while (true) {
    f(i, window.linear(i));
    int axis = 0;
    while (axis < Dim && ++i[axis] == high[axis]) {
      i[axis] = low[axis];
      ++axis;
    }
    if (axis == Dim) return;
  }
}

/// A patch, the nodes around it, and the plane it lies in.
template <int Dim>
struct Piece {
  Index<Dim> low, high;                // Of the nodes of its box grown by the reach.
  Vec<Dim> normal = Vec<Dim>::Zero();  // Zero for points and, in 3D, segments: all planes.
  double offset = 0.0;

  Piece() = default;
  Piece(const Patch<Dim>& patch, const Grid<Dim>& window, double reach) {
    std::tie(low, high) = nodes_in(window, patch.bounds().grown(reach));
    if (patch.count < Dim) return;
    normal = vantage::normal(patch);
    offset = normal.dot(patch.vertices[0]);
  }
  /// No place of the patch is nearer to p.
  [[nodiscard]] double at_least(const Vec<Dim>& p) const { return std::abs(normal.dot(p) - offset) - 1e-9 * (1.0 + std::abs(offset)); }
};

template <int Dim>
Band<Dim> near_band(std::span<const Patch<Dim>> patches, const Grid<Dim>& window, double reach) {
  Band<Dim> band{Field<Dim>(window, std::numeric_limits<float>::infinity()), Field<Dim, std::int32_t>(window, kNoSite)};
  std::vector<Piece<Dim>> pieces(patches.size());
  parallel_for(patches.size(), 1024, [&](std::size_t k) { pieces[k] = Piece<Dim>(patches[k], window, reach); });
  // Slabs along the last axis, so that threads never write to the same node; within a slab the patches come in their order.
  const int axis = Dim - 1;
  const auto layers = static_cast<std::size_t>(window.extent[axis]);
  constexpr std::size_t kSlab = 8;
  std::vector<std::vector<std::int32_t>> slabs((layers + kSlab - 1) / kSlab);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto& [low, high] = std::tie(pieces[k].low, pieces[k].high);
    if ((low.array() >= high.array()).any()) continue;
    for (std::size_t s = static_cast<std::size_t>(low[axis]) / kSlab; s <= static_cast<std::size_t>(high[axis] - 1) / kSlab; ++s)
      slabs[s].push_back(static_cast<std::int32_t>(k));
  }
  parallel_for(slabs.size(), 1, [&](std::size_t s) {
    for (const std::int32_t k : slabs[s]) {
      const Piece<Dim>& piece = pieces[static_cast<std::size_t>(k)];
      Index<Dim> low = piece.low, high = piece.high;
      low[axis] = std::max(low[axis], static_cast<std::int32_t>(s * kSlab));
      high[axis] = std::min(high[axis], static_cast<std::int32_t>((s + 1) * kSlab));
      for_nodes(window, low, high, [&](const Index<Dim>& i, std::size_t node) {
        const Vec<Dim> p = window.position(i);
        if (piece.at_least(p) > std::min(static_cast<double>(band.distance[node]), reach)) return;
        const auto d = static_cast<float>(distance(patches[static_cast<std::size_t>(k)], p));
        if (d < band.distance[node]) {
          band.distance[node] = d;
          band.owner[node] = k;
        }
      });
    }
  });
  return band;
}

/// Steps to the nodes at each squared distance up to `last`, in the order in which nearest_sites() prefers them: by the last coordinate, then the one
/// before it, and so on.
template <int Dim>
std::vector<std::vector<Index<Dim>>> steps_by_square(int last) {
  Grid<Dim> cube;
  const auto side = static_cast<std::int32_t>(std::ceil(std::sqrt(static_cast<double>(last))));
  cube.extent.setConstant(2 * side + 1);
  std::vector<std::vector<Index<Dim>>> steps(static_cast<std::size_t>(last) + 1);
  for (std::size_t i = 0; i < cube.size(); ++i) {
    const Index<Dim> step = cube.local(i).array() - side;
    if (const int square = step.squaredNorm(); square <= last) steps[static_cast<std::size_t>(square)].push_back(step);
  }
  return steps;
}

/// Calls f(node, its nearest node of `set`) for the nodes that are not in the set but within `farthest` steps of it.
template <int Dim, class F>
void for_near(const Field<Dim, std::uint8_t>& set, double farthest, F&& f) {
  const Grid<Dim>& window = set.window;
  const double h = window.spacing;
  const auto last = static_cast<int>(farthest * farthest);
  // The band counts half a step less.
  const NarrowBand band = narrow_band(set, (std::sqrt(static_cast<double>(last)) - 0.5 + 1e-6) * h);
  const auto steps = steps_by_square<Dim>(last);
  parallel_for(band.nodes.size(), 4096, [&](std::size_t k) {
    const std::size_t node = band.nodes[k];
    if (set[node] != 0) return;
    const double length = 0.5 - static_cast<double>(band.distances[k]) / h;
    const Index<Dim> here = window.local(node);
    for (const Index<Dim>& step : steps[static_cast<std::size_t>(length * length + 0.5)]) {
      const Index<Dim> there = here + step;
      if (!window.inside(there)) continue;
      const std::size_t site = window.linear(there);
      if (set[site] != 0) return f(node, site);
    }
  });
}

/// Beyond this, finding the sites of all nodes is quicker.
constexpr double kNear = 6.0;  // [steps]

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> distance_to_patches(std::span<const Patch<Dim>> patches, const Grid<Dim>& window, double cap) {
  const double reach = 0.5 * (1.0 + 1e-9) * std::sqrt(static_cast<double>(Dim)) * window.spacing;
  Band<Dim> band = near_band(patches, window, std::min(reach, cap));
  const auto limit = static_cast<float>(cap);
  if (cap > reach && window.size() > 0) {
    Field<Dim, std::uint8_t> set(window);
    parallel_chunks(set.values.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) set[i] = band.distance[i] <= static_cast<float>(reach);
    });
    const auto ask_owner = [&](std::size_t node, std::size_t site) {
      const auto owner = static_cast<std::size_t>(band.owner[site]);
      band.distance[node] = std::min(band.distance[node], static_cast<float>(distance(patches[owner], window.position(node))));
    };
    const double farthest = (cap + reach) / window.spacing * (1.0 + 1e-9);  // No patch is within the cap of nodes farther from their site.
    if (farthest <= kNear) {
      for_near(set, farthest, ask_owner);
    } else {
      const Field<Dim, std::int32_t> sites = nearest_sites(set);
      parallel_for(sites.values.size(), std::size_t{1} << 14, [&](std::size_t node) {
        if (set[node] != 0 || sites[node] == kNoSite) return;
        const auto site = static_cast<std::size_t>(sites[node]);
        if ((window.local(node) - window.local(site)).template cast<double>().squaredNorm() <= farthest * farthest) ask_owner(node, site);
      });
    }
  }
  parallel_chunks(band.distance.values.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) band.distance[i] = std::min(band.distance[i], limit);
  });
  return std::move(band.distance);
}

template Field<2> distance_to_patches<2>(std::span<const Patch<2>>, const Grid<2>&, double);
template Field<3> distance_to_patches<3>(std::span<const Patch<3>>, const Grid<3>&, double);

}  // namespace vantage
