// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// Which nodes of a window are seen: one state per block of 8 nodes a side, and a bit a node only in blocks that are neither all seen nor all
/// hidden. Blocks are aligned with the global lattice, so windows of one lattice share them; nodes outside the window are not seen.
template <int Dim>
  requires SpatialDim<Dim>
class SeenSet {
 public:
  static constexpr int kSide = 8;                                     ///< Nodes along each edge of a block.
  static constexpr std::size_t kNodes = std::size_t{1} << (3 * Dim);  ///< In a block.
  using Bits = std::array<std::uint8_t, kNodes / kSide>;              ///< A byte per row along axis 0, lowest bit first; rows along axis 1, 2.
  static constexpr std::int32_t kHidden = -1, kSeen = -2;             ///< Entries of blocks without bits.

  explicit SeenSet(const Grid<Dim>& window);
  /// The nodes that are not 0.
  explicit SeenSet(const Field<Dim, std::uint8_t>& nodes);

  [[nodiscard]] const Grid<Dim>& window() const { return window_; }
  /// The lattice of blocks: its node b holds the lattice nodes 8 b .. 8 b + 7.
  [[nodiscard]] const Grid<Dim>& blocks() const { return blocks_; }
  /// The nodes of a block that lie in the window.
  [[nodiscard]] Grid<Dim> nodes(std::size_t block) const;
  /// kHidden, kSeen (only when the whole block lies in the window) or an index for bits().
  [[nodiscard]] std::int32_t entry(std::size_t block) const { return entries_[block]; }
  [[nodiscard]] const Bits& bits(std::int32_t entry) const { return bits_[static_cast<std::size_t>(entry)]; }
  /// Whether a node, counted from the window's first, is seen.
  [[nodiscard]] bool at(const Index<Dim>& local) const;
  /// out[k] = 1 if node `start` + k along axis 0, counted from the window's first, is seen, else 0.
  void read_row(const Index<Dim>& start, std::span<std::uint8_t> out) const;
  /// Index in Bits of a node's row, the node counted from its block's first.
  [[nodiscard]] static std::size_t row_of(const Index<Dim>& within) {
    std::size_t r = 0;
    for (int a = Dim - 1; a >= 1; --a) r = r * kSide + static_cast<std::size_t>(within[a]);
    return r;
  }
  /// The eight nodes of a row of a block, lowest bit first; `row` as in Bits.
  [[nodiscard]] std::uint8_t row(std::size_t block, std::size_t row) const;
  /// Calls f(linear index in the window of the first node, nodes, their bits) for the rows of a block, as far as they lie in the window.
  template <class F>
  void for_rows(std::size_t block, F&& f) const;
  [[nodiscard]] std::size_t count() const;                                         ///< Nodes seen.
  [[nodiscard]] std::size_t mixed() const { return bits_.size() - free_.size(); }  ///< Blocks with bits.
  [[nodiscard]] std::size_t bytes() const {                                        ///< Memory held.
    return (entries_.capacity() + free_.capacity()) * sizeof(std::int32_t) + bits_.capacity() * sizeof(Bits);
  }
  /// Equal sets over equal windows are equal entry by entry when built in the same order of blocks.
  [[nodiscard]] bool operator==(const SeenSet&) const = default;

  /// Sets the entry of a block: `seen` holds its rows; all seen and all hidden blocks take no bits. Blocks are set once each.
  void set(std::size_t block, const Bits& seen);
  void set_uniform(std::size_t block, bool seen) { entries_[block] = seen ? kSeen : kHidden; }
  /// Adds the nodes of another set of the same lattice that lie in this window. Cost: its blocks.
  void unite(const SeenSet& other);

 private:
  /// The block's nodes that lie in the window.
  [[nodiscard]] Bits inside(std::size_t block) const;
  void unite(std::size_t block, const Bits& seen);

  Grid<Dim> window_, blocks_;
  std::vector<std::int32_t> entries_;
  std::vector<Bits> bits_;
  std::vector<std::int32_t> free_;  ///< Of bits_, for new blocks: those of blocks that became all seen.
};

template <int Dim>
  requires SpatialDim<Dim>
template <class F>
void SeenSet<Dim>::for_rows(std::size_t block, F&& f) const {
  const Grid<Dim> part = nodes(block);
  const Index<Dim> first = (blocks_.first + blocks_.local(block)) * kSide, last = part.first + part.extent;
  const unsigned mask = (1U << part.extent[0]) - 1U;
  Index<Dim> node = part.first;
  for (int a = 0; a < Dim;) {
    const Index<Dim> within = node - first;
    f(window_.linear(Index<Dim>(node - window_.first)), part.extent[0], static_cast<unsigned>(row(block, row_of(within))) >> within[0] & mask);
    for (a = 1; a < Dim && ++node[a] == last[a]; ++a) node[a] = part.first[a];
  }
}

}  // namespace vantage
