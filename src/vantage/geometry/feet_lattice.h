// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vantage/geometry/hausdorff.h"

namespace vantage {

/// Feet in the cells of a lattice, so that a place finds those around it.
template <int Rank>
class FeetLattice {
 public:
  using Place = typename ConvexRegion<Rank>::Place;
  using Number = std::array<int, Rank>;

  /// Covers the feet and [low, high], with about kPerCell feet a cell.
  FeetLattice(const Feet<Rank>& feet, Place low, Place high) {
    for (int k = 0; k < Rank; ++k) {
      const auto [least, most] = std::minmax_element(feet.at[k].begin(), feet.at[k].end());
      low[k] = std::min(low[k], *least);
      high[k] = std::max(high[k], *most);
    }
    const Place size = high - low;
    const double cells = static_cast<double>(feet.size()) / kPerCell;
    double spacing = size.maxCoeff() / cells;  // A row of cells at least.
    if (const double volume = size.prod(); volume > 0.0 && Rank == 2) spacing = std::max(spacing, std::sqrt(volume / cells));
    low_ = low;
    std::size_t total = 1;
    for (int k = 0; k < Rank; ++k) {
      count_[k] = spacing > 0.0 ? static_cast<int>(std::clamp(std::ceil(size[k] / spacing), 1.0, cells + 1.0)) : 1;
      width_[k] = size[k] / count_[k];
      total *= static_cast<std::size_t>(count_[k]);
    }
    start_.assign(total + 1, 0);
    std::vector<std::uint32_t> cell(feet.size());
    for (std::size_t i = 0; i < feet.size(); ++i) {
      Place p;
      for (int k = 0; k < Rank; ++k) p[k] = feet.at[k][i];
      cell[i] = static_cast<std::uint32_t>(flat(number(p)));
      ++start_[cell[i] + 1];
    }
    for (std::size_t c = 0; c < total; ++c) start_[c + 1] += start_[c];
    for (auto& axis : sorted_.at) axis.resize(feet.size());
    sorted_.height2.resize(feet.size());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const std::uint32_t to = next[cell[i]]++;
      for (int k = 0; k < Rank; ++k) sorted_.at[k][to] = feet.at[k][i];
      sorted_.height2[to] = feet.height2[i];
    }
  }

  [[nodiscard]] std::size_t size() const { return start_.size() - 1; }
  [[nodiscard]] Place half() const { return 0.5 * width_; }
  [[nodiscard]] Place center(std::size_t cell) const {
    Place p;
    for (int k = 0; k < Rank; ++k) {
      p[k] = low_[k] + (static_cast<double>(cell % static_cast<std::size_t>(count_[k])) + 0.5) * width_[k];
      cell /= static_cast<std::size_t>(count_[k]);
    }
    return p;
  }

  /// Calls `visit(squared distance, foot)` for the feet of one cell.
  template <class Visit>
  void each_in(std::size_t cell, const Place& p, Visit&& visit) const {
    for (std::size_t i = start_[cell]; i < start_[cell + 1]; ++i) {
      double sum = sorted_.height2[i];
      for (int k = 0; k < Rank; ++k) {
        const double d = sorted_.at[k][i] - p[k];
        sum += d * d;
      }
      visit(sum, i);
    }
  }
  /// For all feet in the cells that come within `reach` of p (and a few more).
  template <class Visit>
  void each_near(const Place& p, double reach, Visit&& visit) const {
    const Number first = number(p.array() - reach), last = number(p.array() + reach);
    Number at = first;
    for (;;) {
      each_in(flat(at), p, visit);
      int k = 0;
      while (k < Rank && at[k] == last[k]) {
        at[k] = first[k];
        ++k;
      }
      if (k == Rank) return;
      ++at[k];
    }
  }
  [[nodiscard]] double nearest(const Place& p) const {
    for (double reach = width_.maxCoeff();; reach *= 2.0) {
      double best2 = kInfinity;
      each_near(p, reach, [&best2](double d2, std::size_t) { best2 = std::min(best2, d2); });
      if (best2 <= reach * reach || !(reach < kInfinity)) return std::sqrt(best2);
    }
  }
  [[nodiscard]] const Feet<Rank>& feet() const { return sorted_; }

 private:
  static constexpr double kPerCell = 12.0;
  Place low_, width_;
  Number count_;
  std::vector<std::uint32_t> start_;
  Feet<Rank> sorted_;

  [[nodiscard]] Number number(const Place& p) const {
    Number n;
    for (int k = 0; k < Rank; ++k)
      n[k] = width_[k] > 0.0 ? static_cast<int>(std::clamp((p[k] - low_[k]) / width_[k], 0.0, static_cast<double>(count_[k] - 1))) : 0;
    return n;
  }
  [[nodiscard]] std::size_t flat(const Number& n) const {
    std::size_t cell = 0;
    for (int k = Rank - 1; k >= 0; --k) cell = cell * static_cast<std::size_t>(count_[k]) + static_cast<std::size_t>(n[k]);
    return cell;
  }
};

}  // namespace vantage
