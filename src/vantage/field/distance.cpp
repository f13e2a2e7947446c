// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vantage/base/parallel.h"
#include "vantage/field/tiled_distance.h"

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

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim, std::int32_t> nearest_sites(const Field<Dim, std::uint8_t>& set) {
  return std::move(Transform<Dim>(set, true).site);
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> distance_to_set(const Field<Dim, std::uint8_t>& set, double cap) {
  const Grid<Dim>& window = set.window;
  if (exact_in_float(window)) return tiled_distance(set, cap);
  const Field<Dim, std::int32_t> site = nearest_sites(set);
  Field<Dim> out(window, static_cast<float>(cap));
  parallel_for(out.values.size(), 1 << 12, [&](std::size_t i) {
    if (site[i] == kNoSite) return;
    const Vec<Dim> steps = (window.local(i) - window.local(static_cast<std::size_t>(site[i]))).template cast<double>();
    out[i] = static_cast<float>(std::min(cap, std::sqrt(steps.squaredNorm()) * window.spacing));
  });
  return out;
}

#define VANTAGE_INSTANTIATE(D)                                                     \
  template Field<D, std::int32_t> nearest_sites<D>(const Field<D, std::uint8_t>&); \
  template Field<D> distance_to_set<D>(const Field<D, std::uint8_t>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
