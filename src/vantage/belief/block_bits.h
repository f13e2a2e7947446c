// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// A set of nodes that only grows, in blocks of 8^Dim: uniform blocks cost four bytes, mixed ones a bit a node more.
template <int Dim>
  requires SpatialDim<Dim>
class BlockBits {
 public:
  explicit BlockBits(const Grid<Dim>& window);

  /// Adds the nodes where `phi` > 0. Its window may reach beyond this one's.
  void add(const Field<Dim>& phi);
  [[nodiscard]] bool operator[](std::size_t node) const { return test(window_.local(node)); }
  [[nodiscard]] bool test(const Index<Dim>& local) const;
  /// out[k] = 1 if node `start` + k along axis 0 is in the set, else 0.
  void read_row(const Index<Dim>& start, std::span<std::uint8_t> out) const;

  [[nodiscard]] const Grid<Dim>& window() const { return window_; }
  [[nodiscard]] std::size_t bytes() const;  ///< Memory held.
  [[nodiscard]] std::size_t mixed_blocks() const { return mixed_.size() - free_.size(); }

 private:
  static constexpr std::int32_t kSide = 8;
  static constexpr std::size_t kRows = std::size_t{1} << (3 * (Dim - 1));  // Of a block; a byte each.
  using Block = std::array<std::uint8_t, kRows>;
  static constexpr std::uint32_t kNone = 0, kAll = 1, kFirst = 2;  // What a slot may say; kFirst + i: mixed_[i].

  [[nodiscard]] Block gather(const Field<Dim>& phi, const Grid<Dim>& common, const Index<Dim>& block) const;
  [[nodiscard]] Block inside_of(const Index<Dim>& block) const;
  void unite(std::size_t block, const Block& bits);

  Grid<Dim> window_, blocks_;
  std::vector<std::uint32_t> slot_;
  std::vector<Block> mixed_;
  std::vector<std::uint32_t> free_;
};

}  // namespace vantage
