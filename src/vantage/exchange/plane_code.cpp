// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/plane_code.h"

#include <bit>

namespace vantage {
namespace {

/// Nearest whole number to value / 2^shift, halves upwards.
std::int64_t rounded_shift(std::int64_t value, int shift) { return shift == 0 ? value : (value + (std::int64_t{1} << (shift - 1))) >> shift; }

std::uint32_t hash(std::uint32_t kind, std::uint64_t value) {
  const std::uint64_t h = (value + kind + 1) * 0x9e3779b97f4a7c15ULL;
  return static_cast<std::uint32_t>(h >> 32U);
}

}  // namespace

template <int Dim>
std::array<std::int32_t, Dim> extended_heights(const PlaneLeaf<Dim>& known, const CellNumber<Dim>& cell, int level) {
  constexpr std::int64_t kMost = 1 << 22;
  const auto apart = [&](int a) {
    return (std::int64_t{cell[static_cast<std::size_t>(a)]} << level) - (std::int64_t{known.cell[static_cast<std::size_t>(a)]} << known.level);
  };
  std::int64_t gain = 0;  // From corner to corner, times 2^known.level.
  std::array<std::int32_t, Dim> out{};
  for (int i = 1; i < Dim; ++i) {
    const std::int64_t slope = known.height[static_cast<std::size_t>(i)];
    gain += slope * apart((known.axis + i) % Dim);
    out[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(std::clamp(rounded_shift(slope << level, known.level), -kMost, kMost));
  }
  const std::int64_t low = known.height[0] - apart(known.axis) * PlaneLeaf<Dim>::kSteps + rounded_shift(gain, known.level);
  out[0] = static_cast<std::int32_t>(std::clamp(low, -kMost, kMost));
  return out;
}

template <int Dim>
std::uint8_t met_children(const PlaneLeaf<Dim>& plane, const CellNumber<Dim>& cell, int level) {
  const std::int64_t width = std::int64_t{1} << (level - 1);
  const auto low = [&](const CellNumber<Dim>& child, int a) {
    return (std::int64_t{child[static_cast<std::size_t>(a)]} << (level - 1)) - (std::int64_t{plane.cell[static_cast<std::size_t>(a)]} << plane.level);
  };
  std::uint8_t mask = 0;
  for (int k = 0; k < (1 << Dim); ++k) {
    const CellNumber<Dim> child = child_of<Dim>(cell, k);
    std::int64_t least = std::int64_t{plane.height[0]} << plane.level, most = least;  // Heights over the child, times 2^plane.level.
    for (int i = 1; i < Dim; ++i) {
      const std::int64_t slope = plane.height[static_cast<std::size_t>(i)], from = low(child, (plane.axis + i) % Dim);
      least += std::min(slope * from, slope * (from + width));
      most += std::max(slope * from, slope * (from + width));
    }
    const std::int64_t floor = low(child, plane.axis), unit = std::int64_t{PlaneLeaf<Dim>::kSteps} << plane.level;
    if (most >= floor * unit && least <= (floor + width) * unit) mask |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(k));
  }
  return mask;
}

template <int Dim>
SiteContexts<Dim>::SiteContexts(const Level<Dim>& level, const LevelCell<Dim>& cell) {
  const auto near = level.around(cell.at);
  for (int i = 0; i < kNear; ++i) {
    const LevelCell<Dim>* n = near[static_cast<std::size_t>(i)];
    masks_ = masks_ * 4 + (n == nullptr || !n->known ? 0 : n->mask);
    exists_ = exists_ * 2 + (n != nullptr ? 1 : 0);
    if (n == nullptr || n == &cell) continue;
    bool low = true, high = true;
    for (int a = 0, rest = i; a < Dim; ++a, rest /= 3) {
      low = low && rest % 3 < 2;
      high = high && rest % 3 > 0;
    }
    high_cells_ += high ? 1 : 0;
    if (!low) continue;
    ++low_cells_;
    low_corners_ += n->known && (n->mask & 1) != 0 ? 1 : 0;
    low_centers_ += n->known && (n->mask & 2) != 0 ? 1 : 0;
  }
}

template <int Dim>
std::array<std::uint32_t, 5> SiteContexts<Dim>::corner() const {
  return {hash(0, masks_), hash(1, exists_), hash(2, low_centers_ | low_corners_ << 3U | high_cells_ << 6U),
          hash(3, low_cells_ | high_cells_ << 3U | low_centers_ << 6U), hash(4, std::uint64_t{exists_} << 32U ^ masks_)};
}

template <int Dim>
std::array<std::uint32_t, 5> SiteContexts<Dim>::center() const {
  std::array<std::uint32_t, 5> all = corner();
  for (std::uint32_t& context : all) context = context * 0x85ebca6bU + 1;
  return all;
}

template std::array<std::int32_t, 2> extended_heights<2>(const PlaneLeaf<2>&, const CellNumber<2>&, int);
template std::array<std::int32_t, 3> extended_heights<3>(const PlaneLeaf<3>&, const CellNumber<3>&, int);
template std::uint8_t met_children<2>(const PlaneLeaf<2>&, const CellNumber<2>&, int);
template std::uint8_t met_children<3>(const PlaneLeaf<3>&, const CellNumber<3>&, int);
template class SiteContexts<2>;
template class SiteContexts<3>;

}  // namespace vantage
