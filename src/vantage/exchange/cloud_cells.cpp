// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/cloud_cells.h"

#include <algorithm>
#include <numeric>

#include "vantage/surface/snap.h"

namespace vantage {
namespace {

constexpr std::size_t kFew = 16;  ///< So few points are looked at one by one.

template <int Dim>
bool is_same_cell(const CellNumber<Dim>& a, const CellNumber<Dim>& b, int level) {
  for (std::size_t k = 0; k < Dim; ++k)
    if (((a[k] ^ b[k]) >> level) != 0) return false;
  return true;
}

}  // namespace

template <int Dim>
CloudCells<Dim>::CloudCells(const ExchangeLattice<Dim>& lattice, std::span<const Vec<Dim>> points) : lattice_(lattice) {
  std::vector<std::pair<CellNumber<Dim>, Vec<Dim>>> all;
  all.reserve(points.size());
  for (const Vec<Dim>& p : points)
    if (const auto cell = p.allFinite() ? lattice.cell(p) : std::nullopt) all.emplace_back(*cell, p);
  left_out_ = points.size() - all.size();
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    if (a.first != b.first) return curve_less<Dim>(a.first, b.first);
    return std::lexicographical_compare(a.second.begin(), a.second.end(), b.second.begin(), b.second.end());
  });
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.second == b.second; }), all.end());
  points_.reserve(all.size());
  cells_.reserve(all.size());
  for (const auto& [cell, p] : all) {
    first_.insert(cell, static_cast<std::uint32_t>(points_.size()));
    cells_.push_back(cell);
    points_.push_back(p);
  }
}

template <int Dim>
CellNumber<Dim> CloudCells<Dim>::cell_of(const CellRange& range, int level) const {
  CellNumber<Dim> at = cells_[range.begin];
  for (std::uint32_t& a : at) a >>= level;
  return at;
}

template <int Dim>
std::size_t CloudCells<Dim>::end_of(const CellNumber<Dim>& at, int level, const CellRange& range) const {
  CellNumber<Dim> corner = at;
  for (std::uint32_t& a : corner) a <<= level;
  const auto first = cells_.begin() + static_cast<std::ptrdiff_t>(range.begin), last = cells_.begin() + static_cast<std::ptrdiff_t>(range.end);
  return static_cast<std::size_t>(
      std::partition_point(first, last, [&](const CellNumber<Dim>& cell) { return is_same_cell<Dim>(cell, corner, level); }) - cells_.begin());
}

template <int Dim>
bool CloudCells<Dim>::is_near(const Vec<Dim>& p, double reach) const {
  const auto low = lattice_.cell(p.array() - reach), high = lattice_.cell(p.array() + reach);
  if (!low || !high) return false;
  bool found = false;
  each_cell_between<Dim>(*low, *high, [&](const CellNumber<Dim>& cell) {
    if (found) return;
    const auto first = first_.find(cell);
    if (!first) return;
    for (std::size_t i = *first; i < cells_.size() && cells_[i] == cell && !found; ++i) found = (points_[i] - p).norm() <= reach;
  });
  return found;
}

template <int Dim>
void CloudCells<Dim>::gather(const Box<Dim>& box, std::vector<std::size_t>& out) const {
  if (!points_.empty()) gather(box, all(), ExchangeLattice<Dim>::kDepth, out);
}

template <int Dim>
void CloudCells<Dim>::gather(const Box<Dim>& box, const CellRange& range, int level, std::vector<std::size_t>& out) const {
  while (level > 0 && is_same_cell<Dim>(cells_[range.begin], cells_[range.end - 1], level - 1)) --level;
  if (lattice_.box(cell_of(range, level), level).intersection(box).empty()) return;
  if (level > 0 && range.size() > kFew) {
    each_cell(range, level - 1, [&](const CellRange& part) { gather(box, part, level - 1, out); });
    return;
  }
  for (std::size_t i = range.begin; i < range.end; ++i)
    if (box.contains(points_[i])) out.push_back(i);
}

template class CloudCells<2>;
template class CloudCells<3>;

}  // namespace vantage
