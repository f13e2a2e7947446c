// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/line_minimum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace vantage {
namespace {

constexpr std::ptrdiff_t kStep = 8;  ///< Rows apart that the divide and conquer places; those between are searched together.
constexpr auto kStride = static_cast<std::ptrdiff_t>(kTileLanes);

// Vectors of 16 bytes as gcc and clang know them: every x86-64 and ARM has them.
template <class Real>
struct Wide;
template <>
struct Wide<float> {
  using Type = float __attribute__((vector_size(16)));
};
template <>
struct Wide<double> {
  using Type = double __attribute__((vector_size(16)));
};
template <class Real>
using Vector = typename Wide<Real>::Type;
template <class Real>
inline constexpr std::ptrdiff_t kWidth = 16 / static_cast<std::ptrdiff_t>(sizeof(Real));
template <class Real>
using Row = std::array<Vector<Real>, static_cast<std::size_t>(kStride / kWidth<Real>)>;

template <class Real>
Vector<Real> load(const Real* at) {
  Vector<Real> v;
  std::memcpy(&v, at, sizeof v);
  return v;
}

template <class V>
V lesser(const V& a, const V& b) {
  return a < b ? a : b;
}

template <class Real, class Pick>
Real over_lanes(const Row<Real>& row, Pick pick) {
  Vector<Real> v = row[0];
  for (std::size_t p = 1; p < row.size(); ++p) v = pick(v, row[p]);
  Real one = v[0];
  for (std::ptrdiff_t lane = 1; lane < kWidth<Real>; ++lane) one = pick(one, v[lane]);
  return one;
}

/// Smallest and largest nearest row over the lanes.
struct Reach {
  std::ptrdiff_t low, high;
};

/// What is common to one tile.
template <class Real>
struct Tile {
  const Real* in;
  Real* out;
  std::int32_t* row;    ///< Null: not asked for.
  const Real* squares;  ///< Of 0; entry kWidth k is k^2.
  std::ptrdiff_t length;
};

/// No row farther from i than this can be the nearest: row i itself and the ends of `reach` bound it.
template <class Real>
std::ptrdiff_t radius(const Tile<Real>& t, std::ptrdiff_t i, const Reach& reach) {
  Row<Real> best;
  best.fill(Vector<Real>{} + Real(2) * kFarSquare<Real>);
  for (const std::ptrdiff_t j : {std::clamp(i, reach.low, reach.high), reach.low, reach.high}) {
    const Real* in = t.in + j * kStride;
    for (auto& part : best) {
      part = lesser(load(in) + load(t.squares + kWidth<Real> * (j - i)), part);
      in += kWidth<Real>;
    }
  }
  return static_cast<std::ptrdiff_t>(std::sqrt(over_lanes<Real>(best, [](const auto& a, const auto& b) { return a > b ? a : b; }))) + 1;
}

/// Row i from the rows of `reach`, and where its lanes found their least (the first, if several).
template <class Real>
Reach search(const Tile<Real>& t, std::ptrdiff_t i, Reach reach) {
  if (reach.high - reach.low > 4 * kStep) {
    const std::ptrdiff_t r = radius(t, i, reach);
    reach = {std::max(reach.low, i - r), std::min(reach.high, i + r)};
  }
  Row<Real> best, from;
  best.fill(Vector<Real>{} + Real(2) * kFarSquare<Real>);
  Vector<Real> j = Vector<Real>{} + static_cast<Real>(reach.low);
  from.fill(j);
  const Real* in = t.in + reach.low * kStride;
  for (std::ptrdiff_t k = reach.low - i; k <= reach.high - i; ++k, in += kTileLanes, j += Real(1)) {
    const Vector<Real> square = load(t.squares + kWidth<Real> * k);
    for (std::size_t p = 0; p < best.size(); ++p) {
      const Vector<Real> other = load(in + kWidth<Real> * static_cast<std::ptrdiff_t>(p)) + square;
      from[p] = other < best[p] ? j : from[p];
      best[p] = lesser(other, best[p]);
    }
  }
  std::memcpy(t.out + i * kStride, &best, sizeof best);
  if (t.row != nullptr)
    for (std::size_t lane = 0; lane < kTileLanes; ++lane) {
      const auto width = static_cast<std::size_t>(kWidth<Real>);
      t.row[static_cast<std::size_t>(i) * kTileLanes + lane] = static_cast<std::int32_t>(from[lane / width][lane % width]);
    }
  return {static_cast<std::ptrdiff_t>(over_lanes<Real>(from, [](const auto& a, const auto& b) { return a < b ? a : b; })),
          static_cast<std::ptrdiff_t>(over_lanes<Real>(from, [](const auto& a, const auto& b) { return a > b ? a : b; }))};
}

/// The rows after i, kStep - 1 of them, from the rows of `reach`.
template <class Real>
void fill_between(const Tile<Real>& t, std::ptrdiff_t i, const Reach& reach) {
  constexpr std::size_t kBetween = kStep - 1;
  const auto rows = static_cast<std::size_t>(std::min(kStep, t.length - i)) - 1;
  for (std::ptrdiff_t lane = 0; lane < kStride; lane += kWidth<Real>) {
    std::array<Vector<Real>, kBetween> best;
    best.fill(Vector<Real>{} + Real(2) * kFarSquare<Real>);
    const Real* in = t.in + reach.low * kStride + lane;
    const Real* square = t.squares + kWidth<Real> * (reach.low - i);
    for (std::ptrdiff_t j = reach.low; j <= reach.high; ++j, in += kTileLanes, square += kWidth<Real>) {
      const Vector<Real> value = load(in);
      for (std::size_t row = 0; row < kBetween; ++row)
        best[row] = lesser(value + load(square - kWidth<Real> * static_cast<std::ptrdiff_t>(row + 1)), best[row]);
    }
    Real* out = t.out + (i + 1) * kStride + lane;
    for (std::size_t row = 0; row < rows; ++row) std::memcpy(out + row * kTileLanes, &best[row], sizeof best[row]);
  }
}

/// Rows that are multiples of `finest` by divide and conquer, then those between.
template <class Real>
void place_rows(const Tile<Real>& t, std::ptrdiff_t finest) {
  const std::ptrdiff_t last = t.length - 1;
  std::vector<Reach> found(static_cast<std::size_t>(last / finest + 1));
  const auto placed = [&](std::ptrdiff_t i) -> Reach& { return found[static_cast<std::size_t>(i / finest)]; };
  const auto high = [&](std::ptrdiff_t i) { return i <= last ? placed(i).high : last; };
  placed(0) = search(t, 0, {0, last});
  std::ptrdiff_t stride = finest;
  while (2 * stride <= last) stride *= 2;
  for (; stride >= finest; stride /= 2)
    for (std::ptrdiff_t i = stride; i <= last; i += 2 * stride) placed(i) = search(t, i, {placed(i - stride).low, high(i + stride)});
  if (finest == 1) return;
  for (std::ptrdiff_t i = 0; i <= last; i += finest) fill_between(t, i, {placed(i).low, high(i + finest)});
}

}  // namespace

template <class Real>
LineMinimum<Real>::LineMinimum(std::size_t length) : length_(length) {
  const auto n = static_cast<std::ptrdiff_t>(length) + kStep;
  for (std::ptrdiff_t k = -n; k <= n; ++k)
    squares_.insert(squares_.end(), static_cast<std::size_t>(kWidth<Real>), static_cast<Real>(k) * static_cast<Real>(k));
}

template <class Real>
void LineMinimum<Real>::operator()(const Real* tile, Real* out) const {
  const auto n = static_cast<std::ptrdiff_t>(length_);
  place_rows(Tile<Real>{tile, out, nullptr, squares_.data() + kWidth<Real> * (n + kStep), n}, kStep);
}

template <class Real>
void LineMinimum<Real>::operator()(const Real* tile, Real* out, std::int32_t* row) const {
  const auto n = static_cast<std::ptrdiff_t>(length_);
  place_rows(Tile<Real>{tile, out, row, squares_.data() + kWidth<Real> * (n + kStep), n}, 1);
}

template class LineMinimum<float>;
template class LineMinimum<double>;

}  // namespace vantage
