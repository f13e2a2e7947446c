// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "vantage/field/line_minimum.h"

namespace vantage {
namespace {

using Shorts = std::int16_t __attribute__((vector_size(16)));  // As gcc and clang know them: every x86-64 and ARM has them.

constexpr std::size_t kGroup = 8;  ///< Rows that are looked at or skipped together.
using Row = std::array<Shorts, kTileLanes / 8>;

struct Least {
  Shorts operator()(const Shorts& a, const Shorts& b) const { return a < b ? a : b; }
};
struct Most {
  Shorts operator()(const Shorts& a, const Shorts& b) const { return a > b ? a : b; }
};

template <class Pick>
int over_lanes(const Row& row, Pick pick) {
  Shorts v = pick(row[0], row[1]);
  v = pick(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
  v = pick(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
  v = pick(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6));
  return v[0];
}

/// Values of one side, 0 in place of the other's.
template <int Side>
Row load_side(const std::int16_t* at) {
  Row row;
  std::memcpy(&row, at, sizeof row);
  for (Shorts& part : row) part = Most()(Side > 0 ? part : -part, Shorts{});
  return row;
}

void add_to(std::int16_t* at, const Row& row, int side) {
  Row sum;
  std::memcpy(&sum, at, sizeof sum);
  for (std::size_t p = 0; p < row.size(); ++p) sum[p] += side > 0 ? row[p] : -row[p];
  std::memcpy(at, &sum, sizeof sum);
}

/// Whether any value of the side is in the tile.
template <int Side>
bool has_side(const std::int16_t* tile, std::size_t length) {
  Row most{};
  for (std::size_t i = 0; i < length; ++i) {
    const Row row = load_side<Side>(tile + i * kTileLanes);
    for (std::size_t p = 0; p < row.size(); ++p) most[p] = Most()(most[p], row[p]);
  }
  return over_lanes(most, Most()) != 0;
}

/// The rows [first, last) as row i sees them.
template <int Side>
void look_at(const std::int16_t* tile, std::ptrdiff_t i, std::ptrdiff_t first, std::ptrdiff_t last, Row& best) {
  for (std::ptrdiff_t j = first; j < last; ++j) {
    const Row row = load_side<Side>(tile + static_cast<std::size_t>(j) * kTileLanes);
    const auto square = static_cast<std::int16_t>((j - i) * (j - i));
    for (std::size_t p = 0; p < row.size(); ++p) best[p] = Least()(best[p], row[p] + square);
  }
}

/// Least of the kGroup rows from each on, over all lanes.
template <int Side>
std::vector<std::int16_t> group_minima(const std::int16_t* tile, std::size_t length) {
  std::vector<std::int16_t> least(length + kGroup, std::numeric_limits<std::int16_t>::max());
  for (std::size_t i = 0; i < length; ++i) least[i] = static_cast<std::int16_t>(over_lanes(load_side<Side>(tile + i * kTileLanes), Least()));
  for (std::size_t reach = 1; reach < kGroup; reach *= 2)
    for (std::size_t i = 0; i + reach < least.size(); ++i) least[i] = std::min(least[i], least[i + reach]);
  return least;
}

template <int Side>
void one_side(const std::int16_t* tile, std::int16_t* out, std::size_t length) {
  if (!has_side<Side>(tile, length)) return;
  const std::vector<std::int16_t> least = group_minima<Side>(tile, length);
  const auto n = static_cast<std::ptrdiff_t>(length), group = static_cast<std::ptrdiff_t>(kGroup);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    Row best = load_side<Side>(tile + static_cast<std::size_t>(i) * kTileLanes);
    int worst = over_lanes(best, Most());
    if (worst == 0) continue;  // No node of this side.
    // Outward until nothing farther can be nearer, past groups that hold nothing near.
    for (std::ptrdiff_t k = 1; k * k < worst; k += group) {
      const std::ptrdiff_t above = i + k, below = std::max<std::ptrdiff_t>(i - k - group + 1, 0);
      if (above < n && least[static_cast<std::size_t>(above)] + k * k < worst) look_at<Side>(tile, i, above, std::min(above + group, n), best);
      if (i >= k && least[static_cast<std::size_t>(below)] + k * k < worst) look_at<Side>(tile, i, below, i - k + 1, best);
      worst = over_lanes(best, Most());
    }
    add_to(out + static_cast<std::size_t>(i) * kTileLanes, best, Side);
  }
}

}  // namespace

void SignedLineMinimum::operator()(const std::int16_t* tile, std::int16_t* out) const {
  std::fill(out, out + length_ * kTileLanes, std::int16_t{0});
  one_side<1>(tile, out, length_);
  one_side<-1>(tile, out, length_);
}

}  // namespace vantage
