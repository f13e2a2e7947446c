// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "vantage/base/parallel.h"
#include "vantage/field/distance.h"

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

template <int Dim>
Band<Dim> near_band(std::span<const Patch<Dim>> patches, const Grid<Dim>& window, double reach) {
  Band<Dim> band{Field<Dim>(window, std::numeric_limits<float>::infinity()), Field<Dim, std::int32_t>(window, kNoSite)};
  // Slabs along the last axis, so that threads never write to the same node; within a slab the patches come in their order.
  const int axis = Dim - 1;
  const auto layers = static_cast<std::size_t>(window.extent[axis]);
  constexpr std::size_t kSlab = 8;
  std::vector<std::vector<std::int32_t>> slabs((layers + kSlab - 1) / kSlab);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto [low, high] = nodes_in(window, patches[k].bounds().grown(reach));
    if ((low.array() >= high.array()).any()) continue;
    for (std::size_t s = static_cast<std::size_t>(low[axis]) / kSlab; s <= static_cast<std::size_t>(high[axis] - 1) / kSlab; ++s)
      slabs[s].push_back(static_cast<std::int32_t>(k));
  }
  parallel_for(slabs.size(), 1, [&](std::size_t s) {
    for (const std::int32_t k : slabs[s]) {
      const Patch<Dim>& patch = patches[static_cast<std::size_t>(k)];
      auto [low, high] = nodes_in(window, patch.bounds().grown(reach));
      low[axis] = std::max(low[axis], static_cast<std::int32_t>(s * kSlab));
      high[axis] = std::min(high[axis], static_cast<std::int32_t>((s + 1) * kSlab));
      for_nodes(window, low, high, [&](const Index<Dim>& i, std::size_t node) {
        const auto d = static_cast<float>(distance(patch, window.position(i)));
        if (d < band.distance[node]) {
          band.distance[node] = d;
          band.owner[node] = k;
        }
      });
    }
  });
  return band;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> distance_to_patches(std::span<const Patch<Dim>> patches, const Grid<Dim>& window, double cap) {
  const double reach = 0.5 * (1.0 + 1e-9) * std::sqrt(static_cast<double>(Dim)) * window.spacing;
  Band<Dim> band = near_band(patches, window, std::min(reach, cap));
  const auto limit = static_cast<float>(cap);
  if (cap > reach) {
    Field<Dim, std::uint8_t> set(window);
    for (std::size_t i = 0; i < set.values.size(); ++i) set[i] = band.distance[i] <= static_cast<float>(reach);
    const Field<Dim, std::int32_t> site = nearest_sites(set);
    const double farthest = (cap + reach) / window.spacing * (1.0 + 1e-9);  // No patch is within the cap of nodes farther from their site.
    const auto row = static_cast<std::size_t>(window.extent[0]);
    parallel_for(site.values.size() / std::max<std::size_t>(row, 1), 16, [&](std::size_t r) {
      Index<Dim> here = window.local(r * row);
      for (std::size_t i = r * row; i < (r + 1) * row; ++i, ++here[0]) {
        if (set[i] != 0 || site[i] == kNoSite) continue;
        const auto nearest = static_cast<std::size_t>(site[i]);
        if ((here - window.local(nearest)).template cast<double>().squaredNorm() > farthest * farthest) continue;
        const std::int32_t owner = band.owner[nearest];
        band.distance[i] = static_cast<float>(distance(patches[static_cast<std::size_t>(owner)], window.position(here)));
      }
    });
  }
  for (float& d : band.distance.values) d = std::min(d, limit);
  return std::move(band.distance);
}

template Field<2> distance_to_patches<2>(std::span<const Patch<2>>, const Grid<2>&, double);
template Field<3> distance_to_patches<3>(std::span<const Patch<3>>, const Grid<3>&, double);

}  // namespace vantage
