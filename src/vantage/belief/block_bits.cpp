// SPDX-License-Identifier: Apache-2.0
#include "vantage/belief/block_bits.h"

#include <algorithm>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// Place of row `row` of a block relative to its first node.
template <int Dim>
Index<Dim> row_of_block(std::size_t row, std::int32_t side) {
  Index<Dim> step = Index<Dim>::Zero();
  for (int a = 1; a < Dim; ++a, row /= static_cast<std::size_t>(side)) step[a] = static_cast<std::int32_t>(row % static_cast<std::size_t>(side));
  return step;
}

/// Bits [from, to) of a byte.
std::uint8_t span_of_bits(std::int32_t from, std::int32_t to) { return static_cast<std::uint8_t>((1U << to) - (1U << from)); }

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
BlockBits<Dim>::BlockBits(const Grid<Dim>& window) : window_(window), blocks_(window) {
  blocks_.first.setZero();
  blocks_.extent = (window.extent.array() + (kSide - 1)) / kSide;
  slot_.assign(blocks_.size(), kNone);
}

/// Row by row of 8 nodes, of the block's nodes in `common`, those where phi > 0.
template <int Dim>
  requires SpatialDim<Dim>
typename BlockBits<Dim>::Block BlockBits<Dim>::gather(const Field<Dim>& phi, const Grid<Dim>& common, const Index<Dim>& block) const {
  Block bits{};
  const Index<Dim> first = window_.first + block * kSide;
  const std::int32_t low = std::max(first[0], common.first[0]), high = std::min(first[0] + kSide, common.first[0] + common.extent[0]);
  for (std::size_t row = 0; row < kRows; ++row) {
    Index<Dim> node = first + row_of_block<Dim>(row, kSide);
    node[0] = low;
    if (low >= high || !common.inside(node - common.first)) continue;
    const float* values = phi.values.data() + phi.window.linear(node - phi.window.first);
    unsigned byte = 0;
    for (std::int32_t x = low; x < high; ++x) byte |= static_cast<unsigned>(values[x - low] > 0.0F) << (x - first[0]);
    bits[row] = static_cast<std::uint8_t>(byte);
  }
  return bits;
}

/// The block's nodes that are in the window.
template <int Dim>
  requires SpatialDim<Dim>
typename BlockBits<Dim>::Block BlockBits<Dim>::inside_of(const Index<Dim>& block) const {
  Block bits{};
  for (std::size_t row = 0; row < kRows; ++row) {
    const Index<Dim> node = block * kSide + row_of_block<Dim>(row, kSide);
    if (window_.inside(node)) bits[row] = span_of_bits(0, std::min(kSide, window_.extent[0] - node[0]));
  }
  return bits;
}

template <int Dim>
  requires SpatialDim<Dim>
void BlockBits<Dim>::unite(std::size_t block, const Block& bits) {
  std::uint32_t& slot = slot_[block];
  if (slot == kAll || std::all_of(bits.begin(), bits.end(), [](std::uint8_t row) { return row == 0; })) return;
  Block sum = bits;
  if (slot != kNone)
    for (std::size_t row = 0; row < kRows; ++row) sum[row] |= mixed_[slot - kFirst][row];
  if (sum == inside_of(blocks_.local(block))) {
    if (slot != kNone) free_.push_back(slot - kFirst);
    slot = kAll;
    return;
  }
  if (slot == kNone) {
    if (free_.empty()) {
      free_.push_back(static_cast<std::uint32_t>(mixed_.size()));
      mixed_.emplace_back();
    }
    slot = free_.back() + kFirst;
    free_.pop_back();
  }
  mixed_[slot - kFirst] = sum;
}

template <int Dim>
  requires SpatialDim<Dim>
void BlockBits<Dim>::add(const Field<Dim>& phi) {
  const Grid<Dim> common = intersection(phi.window, window_);
  if (common.size() == 0) return;
  Grid<Dim> touched = blocks_;
  touched.first = (common.first - window_.first).array() / kSide;
  touched.extent = (common.first + common.extent - window_.first).array() - 1;
  touched.extent = touched.extent.array() / kSide + 1 - touched.first.array();
  std::vector<Block> bits(touched.size());
  parallel_for(bits.size(), 64, [&](std::size_t i) { bits[i] = gather(phi, common, touched.first + touched.local(i)); });
  for (std::size_t i = 0; i < bits.size(); ++i) unite(blocks_.linear(touched.first + touched.local(i)), bits[i]);
}

template <int Dim>
  requires SpatialDim<Dim>
bool BlockBits<Dim>::test(const Index<Dim>& local) const {
  std::uint8_t value = 0;
  read_row(local, std::span(&value, 1));
  return value != 0;
}

template <int Dim>
  requires SpatialDim<Dim>
void BlockBits<Dim>::read_row(const Index<Dim>& start, std::span<std::uint8_t> out) const {
  std::size_t row = 0;
  for (int a = Dim - 1; a > 0; --a) row = row * kSide + static_cast<std::size_t>(start[a] % kSide);
  const std::size_t first_block = blocks_.linear(start.array() / kSide);
  const auto shift = static_cast<std::size_t>(start[0] % kSide);
  for (std::size_t k = 0; k < out.size();) {
    const std::size_t place = shift + k, end = std::min(out.size(), k + kSide - place % kSide);
    const std::uint32_t slot = slot_[first_block + place / kSide];
    if (slot < kFirst) {
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(k), out.begin() + static_cast<std::ptrdiff_t>(end), static_cast<std::uint8_t>(slot));
      k = end;
      continue;
    }
    for (unsigned byte = mixed_[slot - kFirst][row] >> (place % kSide); k < end; ++k, byte >>= 1) out[k] = static_cast<std::uint8_t>(byte & 1U);
  }
}

template <int Dim>
  requires SpatialDim<Dim>
std::size_t BlockBits<Dim>::bytes() const {
  return slot_.capacity() * sizeof(std::uint32_t) + mixed_.capacity() * sizeof(Block) + free_.capacity() * sizeof(std::uint32_t);
}

template class BlockBits<2>;
template class BlockBits<3>;

}  // namespace vantage
