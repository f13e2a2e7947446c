// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// What a ray needs to know of a node in one byte: its state, and how far around it all nodes are in the same state. In blocks of 64 nodes, a line of
/// the cache each.
template <int Dim>
  requires SpatialDim<Dim>
class MarchGrid {
 public:
  static constexpr int kFar = 63;  ///< Distances count up to here [cells].

  MarchGrid() = default;
  /// Cost: two passes over the lattice.
  explicit MarchGrid(const Field<Dim, NodeState>& state);

  /// `local` inside the window, or one beyond its last node (rounding): that is the last node's.
  [[nodiscard]] std::uint8_t code(const Index<Dim>& local) const {
    std::size_t place = 0;
    for (std::size_t a = 0; a < Dim; ++a) place += offset_[a][static_cast<std::size_t>(local[static_cast<int>(a)])];
    return codes_[place];
  }
  [[nodiscard]] static NodeState state(std::uint8_t code) { return static_cast<NodeState>(code >> 6); }
  /// Largest D so that all nodes less than D away along every axis are in this node's state; of obstacles 1.
  [[nodiscard]] static int distance(std::uint8_t code) { return code & kFar; }
  /// True if since `before` nodes have only turned from unseen to seen and from either to obstacle; false for another window.
  [[nodiscard]] bool grown_from(const MarchGrid& before) const;
  [[nodiscard]] const Grid<Dim>& window() const { return window_; }

 private:
  static constexpr std::uint32_t kSide = 1U << (6 / Dim);  // Of a block [nodes].

  Grid<Dim> window_;
  std::array<std::vector<std::uint32_t>, Dim> offset_;  // A node's place is the sum of one entry for each axis.
  std::vector<std::uint8_t> codes_;
};

/// Chessboard distance of every node in `state` to the nearest node in another one, at most MarchGrid::kFar; 0 for all others. What lies outside of
/// the window counts as alike. One value a node, axis 0 fastest.
template <int Dim>
[[nodiscard]] Field<Dim, std::uint8_t> chessboard_distance(const Field<Dim, NodeState>& states, NodeState state);

}  // namespace vantage
