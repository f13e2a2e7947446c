// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/exchange/cell_table.h"
#include "vantage/exchange/leaves.h"

namespace vantage {

/// Points of a scan that are in one cell: an interval of those in Morton order.
struct CellRange {
  std::size_t begin = 0, end = 0;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// The points of a scan, each once, sorted along the Morton curve of their cells; the same for any order they come in.
template <int Dim>
class CloudCells {
 public:
  CloudCells(const ExchangeLattice<Dim>& lattice, std::span<const Vec<Dim>> points);

  [[nodiscard]] const std::vector<Vec<Dim>>& points() const { return points_; }
  [[nodiscard]] const std::vector<CellNumber<Dim>>& cells() const { return cells_; }
  [[nodiscard]] CellRange all() const { return {0, points_.size()}; }
  /// Not finite, or outside the lattice.
  [[nodiscard]] std::size_t left_out() const { return left_out_; }
  /// Number at `level` of the cell of a range's points.
  [[nodiscard]] CellNumber<Dim> cell_of(const CellRange& range, int level) const;
  /// Calls `visit(range)` for the cells of `level` that hold points of `range`, in order.
  template <class Visit>
  void each_cell(const CellRange& range, int level, Visit&& visit) const {
    for (CellRange part{range.begin, range.begin}; part.end < range.end; part.begin = part.end) {
      const CellNumber<Dim> at = cell_of({part.begin, part.begin + 1}, level);
      part.end = end_of(at, level, {part.begin, range.end});
      visit(part);
    }
  }
  /// Is there a point within `reach` of p?
  [[nodiscard]] bool is_near(const Vec<Dim>& p, double reach) const;
  /// Appends the numbers of the points in `box`, in order.
  void gather(const Box<Dim>& box, std::vector<std::size_t>& out) const;

 private:
  ExchangeLattice<Dim> lattice_;
  std::vector<Vec<Dim>> points_;
  std::vector<CellNumber<Dim>> cells_;
  CellTable<Dim> first_;  ///< Number of the first point of each cell of level 0.
  std::size_t left_out_ = 0;

  /// Where the points of cell `at` end, which begin where `range` does.
  [[nodiscard]] std::size_t end_of(const CellNumber<Dim>& at, int level, const CellRange& range) const;
  void gather(const Box<Dim>& box, const CellRange& range, int level, std::vector<std::size_t>& out) const;
};

}  // namespace vantage
