// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// Lower envelope of the parabolas (x - i)^2 + height[i]: for every x which i is lowest, smaller i first; kNoSite if no height is finite.
struct Envelope {
  std::vector<std::int32_t> apex;
  std::vector<double> from;  // apex[k] is lowest from here on.

  void build(std::span<const std::int32_t> height, std::span<std::int32_t> lowest) {
    apex.clear();
    from.clear();
    const auto n = static_cast<std::int32_t>(height.size());
    for (std::int32_t i = 0; i < n; ++i) {
      if (height[static_cast<std::size_t>(i)] < 0) continue;
      double start = -kInfinity;
      while (!apex.empty()) {
        const std::int32_t j = apex.back();
        const auto gap = static_cast<double>(height[static_cast<std::size_t>(i)] - height[static_cast<std::size_t>(j)]);
        start = (gap / (i - j) + (i + j)) * 0.5;
        if (start > from.back()) break;
        apex.pop_back();
        from.pop_back();
        start = -kInfinity;
      }
      apex.push_back(i);
      from.push_back(start);
    }
    std::size_t k = 0;
    for (std::int32_t x = 0; x < n; ++x) {
      while (k + 1 < apex.size() && from[k + 1] < x) ++k;
      lowest[static_cast<std::size_t>(x)] = apex.empty() ? kNoSite : apex[k];
    }
  }
};

/// Squared lattice distance to the nearest node of the set so far (-1: none), and that node when asked for.
template <int Dim>
struct Transform {
  Field<Dim, std::int32_t> squared;
  Field<Dim, std::int32_t> site;  // Empty when not asked for.

  Transform(const Field<Dim, std::uint8_t>& set, bool with_sites) : squared(set.window, -1) {
    if (with_sites) site = Field<Dim, std::int32_t>(set.window, kNoSite);
    for (std::size_t i = 0; i < set.values.size(); ++i) {
      if (set[i] == 0) continue;
      squared[i] = 0;
      if (with_sites) site[i] = static_cast<std::int32_t>(i);
    }
    for (int axis = 0; axis < Dim; ++axis) pass(axis);
  }

 private:
  /// One axis: each node takes the best of its line. Lines come in tiles of neighbours, so that memory is read in order whatever the axis.
  void pass(int axis) {
    const Grid<Dim>& grid = squared.window;
    const auto length = static_cast<std::size_t>(grid.extent[axis]);
    if (length == 0) return;
    const std::size_t stride = grid.stride(axis), lines = grid.size() / length;
    const bool with_sites = !site.values.empty();
    parallel_chunks(lines, 32, [&](std::size_t begin, std::size_t end) {
      Envelope envelope;
      const std::size_t count = end - begin;
      std::vector<std::int32_t> height(count * length), lowest(length), old_site(with_sites ? count * length : 0);
      std::vector<std::size_t> start(count);
      for (std::size_t k = 0; k < count; ++k) start[k] = ((begin + k) / stride) * stride * length + (begin + k) % stride;
      for (std::size_t i = 0; i < length; ++i)
        for (std::size_t k = 0; k < count; ++k) {
          height[k * length + i] = squared[start[k] + i * stride];
          if (with_sites) old_site[k * length + i] = site[start[k] + i * stride];
        }
      std::vector<std::int32_t> new_height(count * length, -1), new_site(with_sites ? count * length : 0, kNoSite);
      for (std::size_t k = 0; k < count; ++k) {
        const std::span<const std::int32_t> line(height.data() + k * length, length);
        envelope.build(line, lowest);
        for (std::size_t i = 0; i < length && lowest[i] != kNoSite; ++i) {
          const auto from = static_cast<std::size_t>(lowest[i]);
          const auto step = static_cast<std::int32_t>(i) - lowest[i];
          new_height[k * length + i] = line[from] + step * step;
          if (with_sites) new_site[k * length + i] = old_site[k * length + from];
        }
      }
      for (std::size_t i = 0; i < length; ++i)
        for (std::size_t k = 0; k < count; ++k) {
          squared[start[k] + i * stride] = new_height[k * length + i];
          if (with_sites) site[start[k] + i * stride] = new_site[k * length + i];
        }
    });
  }
};

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
Field<Dim, std::int32_t> nearest_sites(const Field<Dim, std::uint8_t>& set) {
  return std::move(Transform<Dim>(set, true).site);
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> distance_to_set(const Field<Dim, std::uint8_t>& set, double cap) {
  const Transform<Dim> transform(set, false);
  Field<Dim> out(set.window);
  parallel_for(out.values.size(), 1 << 14, [&](std::size_t i) {
    const std::int32_t squared = transform.squared[i];
    out[i] = static_cast<float>(squared < 0 ? cap : std::min(cap, std::sqrt(static_cast<double>(squared)) * set.window.spacing));
  });
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> distance_to_patches(std::span<const Patch<Dim>> patches, const Grid<Dim>& window, double cap) {
  const double diagonal = std::sqrt(static_cast<double>(Dim)) * window.spacing;
  Band<Dim> band = near_band(patches, window, std::min(diagonal, cap));
  const auto limit = static_cast<float>(cap);
  if (cap > diagonal) {
    Field<Dim, std::uint8_t> set(window);
    for (std::size_t i = 0; i < set.values.size(); ++i) set[i] = band.distance[i] <= static_cast<float>(diagonal);
    const Field<Dim, std::int32_t> site = nearest_sites(set);
    parallel_for(site.values.size(), 1 << 12, [&](std::size_t i) {
      if (set[i] != 0 || site[i] == kNoSite) return;
      const std::int32_t owner = band.owner[static_cast<std::size_t>(site[i])];
      band.distance[i] = static_cast<float>(distance(patches[static_cast<std::size_t>(owner)], window.position(i)));
    });
  }
  for (float& d : band.distance.values) d = std::min(d, limit);
  return std::move(band.distance);
}

#define VANTAGE_INSTANTIATE(D)                                                              \
  template Field<D, std::int32_t> nearest_sites<D>(const Field<D, std::uint8_t>&);          \
  template Field<D> distance_to_set<D>(const Field<D, std::uint8_t>&, double);              \
  template Field<D> distance_to_patches<D>(std::span<const Patch<D>>, const Grid<D>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
