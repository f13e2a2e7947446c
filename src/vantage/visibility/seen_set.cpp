// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/seen_set.h"

#include <algorithm>
#include <bit>

namespace vantage {
namespace {

std::int32_t block_of(std::int32_t node, int side) { return node >= 0 ? node / side : -((-node - 1) / side) - 1; }

template <int Dim>
Grid<Dim> blocks_over(const Grid<Dim>& window, int side) {
  Grid<Dim> blocks{window.spacing * side, window.first, window.extent};
  for (int a = 0; a < Dim; ++a) {
    blocks.first[a] = block_of(window.first[a], side);
    blocks.extent[a] = window.extent[a] > 0 ? block_of(window.first[a] + window.extent[a] - 1, side) - blocks.first[a] + 1 : 0;
  }
  return blocks;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
SeenSet<Dim>::SeenSet(const Grid<Dim>& window) : window_(window), blocks_(blocks_over(window, kSide)), entries_(blocks_.size(), kHidden) {}

template <int Dim>
  requires SpatialDim<Dim>
Grid<Dim> SeenSet<Dim>::nodes(std::size_t block) const {
  Grid<Dim> all = window_;
  all.first = (blocks_.first + blocks_.local(block)) * kSide;
  all.extent.setConstant(kSide);
  return intersection(all, window_);
}

template <int Dim>
  requires SpatialDim<Dim>
std::uint8_t SeenSet<Dim>::row(std::size_t block, std::size_t row) const {
  const std::int32_t e = entries_[block];
  return e >= 0 ? bits(e)[row] : e == kSeen ? std::uint8_t{0xff} : std::uint8_t{0};
}

template <int Dim>
  requires SpatialDim<Dim>
bool SeenSet<Dim>::at(const Index<Dim>& local) const {
  const Index<Dim> node = local + window_.first - blocks_.first * kSide;  // None is negative.
  const Index<Dim> block = node / kSide, within = node - block * kSide;
  return (row(blocks_.linear(block), row_of(within)) >> within[0] & 1) != 0;
}

template <int Dim>
  requires SpatialDim<Dim>
std::size_t SeenSet<Dim>::count() const {
  std::size_t sum = kNodes * static_cast<std::size_t>(std::count(entries_.begin(), entries_.end(), kSeen));
  for (const Bits& block : bits_)
    for (const std::uint8_t byte : block) sum += static_cast<std::size_t>(std::popcount(byte));
  return sum;
}

template <int Dim>
  requires SpatialDim<Dim>
void SeenSet<Dim>::set(std::size_t block, const Bits& seen) {
  const auto all = [&](std::uint8_t byte) { return std::all_of(seen.begin(), seen.end(), [=](std::uint8_t b) { return b == byte; }); };
  if (all(0x00) || all(0xff)) return set_uniform(block, seen[0] != 0);
  entries_[block] = static_cast<std::int32_t>(bits_.size());
  bits_.push_back(seen);
}

template class SeenSet<2>;
template class SeenSet<3>;

}  // namespace vantage
