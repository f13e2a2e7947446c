// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "vantage/exchange/cell_table.h"

namespace vantage {

[[nodiscard]] constexpr int power(int base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

/// A cell of the tree while it is coded.
template <int Dim>
struct LevelCell {
  CellNumber<Dim> at{};
  std::uint8_t mask = 0;     ///< Children that hold something, as far as known; at level 0 the sites.
  bool known = false;        ///< All of `mask` is.
  bool below_plane = false;  ///< Only part of a plane's cell that the plane meets: nothing to code, but worth knowing to its neighbours.
  bool bare = false;         ///< A plane's cell that holds nothing else.
  std::int32_t plane = -1;   ///< Number of the plane in it, if any.
};

/// The cells of one level in Morton order.
template <int Dim>
class Level {
 public:
  static constexpr int kNear = power(3, Dim);
  explicit Level(std::vector<LevelCell<Dim>> all) : cells(std::move(all)), table_(cells.size()) {
    for (std::size_t i = 0; i < cells.size(); ++i) table_.insert(cells[i].at, static_cast<std::uint32_t>(i));
  }
  /// The cells around `at` and itself, the first axis fastest; nullptr where there is none.
  [[nodiscard]] std::array<const LevelCell<Dim>*, kNear> around(const CellNumber<Dim>& at) const {
    std::array<const LevelCell<Dim>*, kNear> near{};
    for (int i = 0; i < kNear; ++i) {
      CellNumber<Dim> other = at;
      for (int a = 0, rest = i; a < Dim; ++a, rest /= 3) other[a] += static_cast<std::uint32_t>(rest % 3 - 1);
      if (const auto found = table_.find(other)) near[static_cast<std::size_t>(i)] = &cells[*found];
    }
    return near;
  }

  std::vector<LevelCell<Dim>> cells;

 private:
  CellTable<Dim> table_;
};

/// Number of child k of `cell`.
template <int Dim>
[[nodiscard]] CellNumber<Dim> child_of(const CellNumber<Dim>& cell, int k) {
  CellNumber<Dim> at = cell;
  for (int a = 0; a < Dim; ++a) at[a] = 2 * at[a] + (static_cast<std::uint32_t>(k) >> a & 1U);
  return at;
}

}  // namespace vantage
