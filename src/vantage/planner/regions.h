// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vantage/field/grid.h"

namespace vantage {

/// Which nodes hang together over faces: the connected regions of a set of nodes, kept as runs along axis 0. Cost: one look at every node, then in
/// proportion to the runs. Same result for any number of threads.
template <int Dim>
  requires SpatialDim<Dim>
class Regions {
 public:
  struct Run {
    std::uint32_t begin = 0, end = 0;  ///< Nodes [begin, end) of a row.
    std::int32_t region = 0;           ///< Regions are numbered from 0 in order of their first nodes.
  };
  /// `fill(first, members)` says of the row of nodes that begins at linear index `first` which are in the set (1, else 0).
  Regions(const Grid<Dim>& window, const std::function<void(std::size_t, std::span<std::uint8_t>)>& fill);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t rows() const { return first_run_.size() - 1; }
  [[nodiscard]] std::size_t row_length() const { return static_cast<std::size_t>(window_.extent[0]); }
  [[nodiscard]] std::span<const Run> row(std::size_t number) const {
    return std::span(runs_).subspan(first_run_[number], first_run_[number + 1] - first_run_[number]);
  }
  /// -1 for nodes outside of the set.
  [[nodiscard]] std::int32_t region_of(std::size_t node) const;

 private:
  Grid<Dim> window_;
  std::vector<std::size_t> first_run_;  // Of every row, and the end.
  std::vector<Run> runs_;
  std::size_t count_ = 0;
};

}  // namespace vantage
