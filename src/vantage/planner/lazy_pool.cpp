// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/lazy_pool.h"

#include <algorithm>
#include <tuple>

#include "vantage/base/parallel.h"

namespace vantage {

template <int Dim>
  requires SpatialDim<Dim>
LazyPool<Dim>::LazyPool(const Grid<Dim>& window, std::size_t most_blocks) : window_(window), blocks_(window) {
  const auto cut = [&] { blocks_.extent = (window_.extent.array() + (side_ - 1)) / side_; };
  for (cut(); blocks_.size() > std::max<std::size_t>(most_blocks, 1); cut()) side_ *= 2;
  taken_.assign(blocks_.size(), 0);
}

template <int Dim>
  requires SpatialDim<Dim>
void LazyPool<Dim>::offer(std::span<const std::size_t> nodes) {
  for (const std::size_t node : nodes) {
    std::uint8_t& taken = taken_[blocks_.linear(window_.local(node) / side_)];
    if (taken == 0) pool_.push_back({node, kInfinity});
    taken = 1;
  }
}

template <int Dim>
  requires SpatialDim<Dim>
void LazyPool<Dim>::forget() {
  for (Gain& candidate : pool_) candidate.volume = kInfinity;
}

template <int Dim>
  requires SpatialDim<Dim>
auto LazyPool<Dim>::best(const RayMarch<Dim>& rays, std::span<const Vec<Dim>> directions, const Field<Dim, std::uint8_t>& reachable,
                         std::span<const Vec<Dim>> visited) -> std::vector<Gain> {
  constexpr std::size_t kTogether = 16;  // Looked at in parallel.
  // What may not be stood on makes room for others of its block.
  std::erase_if(pool_, [&](const Gain& candidate) {
    const Vec<Dim> p = window_.position(candidate.node);
    const bool out = reachable[candidate.node] == 0 ||
                     std::any_of(visited.begin(), visited.end(), [&](const Vec<Dim>& v) { return (p - v).norm() < 2.0 * window_.spacing; });
    if (out) taken_[blocks_.linear(window_.local(candidate.node) / side_)] = 0;
    return out;
  });
  const auto before = [](const Gain& a, const Gain& b) { return std::tuple(-a.volume, a.node) < std::tuple(-b.volume, b.node); };
  std::sort(pool_.begin(), pool_.end(), before);
  std::size_t looked = 0;
  Gain top{0, -1.0};
  while (looked < pool_.size() && !(top.volume >= 0.0 && before(top, pool_[looked]))) {
    const std::size_t count = std::min(kTogether, pool_.size() - looked);
    const std::span<Gain> some = std::span(pool_).subspan(looked, count);
    parallel_for(count, 1, [&](std::size_t i) { some[i].volume = rays.unseen_volume(window_.position(some[i].node), directions); });
    for (const Gain& candidate : some)
      if (top.volume < 0.0 || before(candidate, top)) top = candidate;
    looked += count;
  }
  std::vector<Gain> gains(pool_.begin(), pool_.begin() + static_cast<std::ptrdiff_t>(looked));
  std::sort(gains.begin(), gains.end(), before);
  return gains;
}

template class LazyPool<2>;
template class LazyPool<3>;

}  // namespace vantage
