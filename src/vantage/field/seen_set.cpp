// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/seen_set.h"

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
SeenSet<Dim>::SeenSet(const Field<Dim, std::uint8_t>& nodes) : SeenSet(nodes.window) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Bits bits{};
    const Grid<Dim> part = this->nodes(b);
    const Index<Dim> first = (blocks_.first + blocks_.local(b)) * kSide;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Index<Dim> node = part.first + part.local(i), within = node - first;
      if (nodes.at(node - window_.first) != 0) bits[row_of(within)] |= static_cast<std::uint8_t>(1U << within[0]);
    }
    set(b, bits);
  }
}

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

template <int Dim>
  requires SpatialDim<Dim>
void SeenSet<Dim>::read_row(const Index<Dim>& start, std::span<std::uint8_t> out) const {
  const Index<Dim> node = start + window_.first - blocks_.first * kSide, block = node / kSide, within = node - block * kSide;
  const std::size_t first = blocks_.linear(block), in_block = row_of(within);
  const auto shift = static_cast<std::size_t>(within[0]);
  for (std::size_t k = 0; k < out.size();) {
    const std::size_t place = shift + k, end = std::min(out.size(), k + kSide - place % kSide);
    for (unsigned byte = static_cast<unsigned>(row(first + place / kSide, in_block)) >> (place % kSide); k < end; ++k, byte >>= 1)
      out[k] = static_cast<std::uint8_t>(byte & 1U);
  }
}

template <int Dim>
  requires SpatialDim<Dim>
typename SeenSet<Dim>::Bits SeenSet<Dim>::inside(std::size_t block) const {
  Bits all{};
  const Grid<Dim> part = nodes(block);
  const Index<Dim> first = (blocks_.first + blocks_.local(block)) * kSide;
  Grid<Dim> rows = part;
  rows.extent[0] = 1;
  for (std::size_t i = 0; i < rows.size(); ++i)
    all[row_of(part.first + rows.local(i) - first)] = static_cast<std::uint8_t>(((1 << part.extent[0]) - 1) << (part.first[0] - first[0]));
  return all;
}

template <int Dim>
  requires SpatialDim<Dim>
void SeenSet<Dim>::unite(std::size_t block, const Bits& seen) {
  std::int32_t& entry = entries_[block];
  if (entry == kSeen) return;
  Bits sum = seen;
  if (entry >= 0)
    for (std::size_t r = 0; r < sum.size(); ++r) sum[r] |= bits(entry)[r];
  const auto all = [&](std::uint8_t byte) { return std::all_of(sum.begin(), sum.end(), [=](std::uint8_t b) { return b == byte; }); };
  if (all(0x00)) return;
  if (all(0xff)) {
    if (entry >= 0) {
      bits_[static_cast<std::size_t>(entry)].fill(0);
      free_.push_back(entry);
    }
    entry = kSeen;
    return;
  }
  if (entry < 0 && free_.empty()) {
    free_.push_back(static_cast<std::int32_t>(bits_.size()));
    bits_.emplace_back();
  }
  if (entry < 0) {
    entry = free_.back();
    free_.pop_back();
  }
  bits_[static_cast<std::size_t>(entry)] = sum;
}

template <int Dim>
  requires SpatialDim<Dim>
void SeenSet<Dim>::unite(const SeenSet& other) {
  const Index<Dim> shift = other.blocks_.first - blocks_.first;
  for (std::size_t b = 0; b < other.entries_.size(); ++b) {
    if (other.entries_[b] == kHidden) continue;
    const Index<Dim> at = other.blocks_.local(b) + shift;
    if (!blocks_.inside(at)) continue;
    const std::size_t block = blocks_.linear(at);
    if (entries_[block] == kSeen) continue;
    Bits seen = inside(block);
    for (std::size_t r = 0; r < seen.size(); ++r) seen[r] &= other.row(b, r);
    unite(block, seen);
  }
}

template class SeenSet<2>;
template class SeenSet<3>;

}  // namespace vantage
