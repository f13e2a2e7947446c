// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/line_minimum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace vantage {
namespace {

// Vectors of 16 bytes as gcc and clang know them: every x86-64 and ARM has them.
using Floats = float __attribute__((vector_size(16)));

template <class V, class T>
V load(const T* at) {
  V v;
  std::memcpy(&v, at, sizeof v);
  return v;
}

template <class V, class T>
void store(T* at, const V& v) {
  std::memcpy(at, &v, sizeof v);
}

constexpr std::size_t kParts = kLanes / 4;
constexpr std::ptrdiff_t kStep = 8;  ///< Rows apart that the divide and conquer places; those between are searched together.
constexpr auto kStride = static_cast<std::ptrdiff_t>(kLanes);
using Row = std::array<Floats, kParts>;

Floats lesser(const Floats& a, const Floats& b) { return a < b ? a : b; }
Floats larger(const Floats& a, const Floats& b) { return a > b ? a : b; }

float least(const Row& row) {
  const Floats v = lesser(lesser(row[0], row[1]), lesser(row[2], row[3]));
  return std::min(std::min(v[0], v[1]), std::min(v[2], v[3]));
}

float most(const Row& row) {
  const Floats v = larger(larger(row[0], row[1]), larger(row[2], row[3]));
  return std::max(std::max(v[0], v[1]), std::max(v[2], v[3]));
}

/// Smallest and largest nearest row over the lanes.
struct Reach {
  std::ptrdiff_t low, high;
};

/// What is common to one tile.
struct Tile {
  const float* in;
  float* out;
  const float* squares;  ///< Of 0; entry 4 k is k^2.
  std::ptrdiff_t length;
};

/// No row farther from i than this can be the nearest: row i itself and the ends of `reach` bound it.
std::ptrdiff_t radius(const Tile& t, std::ptrdiff_t i, const Reach& reach) {
  Row best;
  best.fill(Floats{} + 2.0F * kFarSquare);
  for (const std::ptrdiff_t j : {std::clamp(i, reach.low, reach.high), reach.low, reach.high})
    for (std::size_t p = 0; p < kParts; ++p) best[p] = lesser(load<Floats>(t.in + j * kStride + 4 * p) + load<Floats>(t.squares + 4 * (j - i)), best[p]);
  return static_cast<std::ptrdiff_t>(std::sqrt(most(best))) + 1;
}

/// Row i from the rows of `reach`, and where its lanes found their least (the first, if several).
Reach search(const Tile& t, std::ptrdiff_t i, Reach reach) {
  if (reach.high - reach.low > 4 * kStep) {
    const std::ptrdiff_t r = radius(t, i, reach);
    reach = {std::max(reach.low, i - r), std::min(reach.high, i + r)};
  }
  Row best, from;
  best.fill(Floats{} + 2.0F * kFarSquare);
  Floats j = Floats{} + static_cast<float>(reach.low);
  from.fill(j);
  const float* in = t.in + reach.low * kStride;
  for (std::ptrdiff_t k = reach.low - i; k <= reach.high - i; ++k, in += kLanes, j += 1.0F) {
    const Floats square = load<Floats>(t.squares + 4 * k);
    for (std::size_t p = 0; p < kParts; ++p) {
      const Floats other = load<Floats>(in + 4 * p) + square;
      from[p] = other < best[p] ? j : from[p];
      best[p] = lesser(other, best[p]);
    }
  }
  store(t.out + i * kStride, best);
  return {static_cast<std::ptrdiff_t>(least(from)), static_cast<std::ptrdiff_t>(most(from))};
}

/// The rows after i, kStep - 1 of them, from the rows of `reach`.
void fill_between(const Tile& t, std::ptrdiff_t i, const Reach& reach) {
  constexpr std::size_t kBetween = kStep - 1;
  const auto rows = static_cast<std::size_t>(std::min(kStep, t.length - i)) - 1;
  for (std::size_t p = 0; p < kParts; ++p) {
    std::array<Floats, kBetween> best;
    best.fill(Floats{} + 2.0F * kFarSquare);
    const float* in = t.in + reach.low * kStride + 4 * p;
    const float* square = t.squares + 4 * (reach.low - i);
    for (std::ptrdiff_t j = reach.low; j <= reach.high; ++j, in += kLanes, square += 4) {
      const Floats value = load<Floats>(in);
      for (std::size_t row = 0; row < kBetween; ++row)
        best[row] = lesser(value + load<Floats>(square - 4 * static_cast<std::ptrdiff_t>(row + 1)), best[row]);
    }
    for (std::size_t row = 0; row < rows; ++row) store(t.out + (i + 1) * kStride + row * kLanes + 4 * p, best[row]);
  }
}

}  // namespace

LineMinimum::LineMinimum(std::size_t length) : length_(length) {
  const auto n = static_cast<std::ptrdiff_t>(length) + kStep;
  for (std::ptrdiff_t k = -n; k <= n; ++k) squares_.insert(squares_.end(), 4, static_cast<float>(k * k));
}

void LineMinimum::operator()(const float* tile, float* out) const {
  const auto n = static_cast<std::ptrdiff_t>(length_), last = n - 1;
  const Tile t{tile, out, squares_.data() + 4 * (n + kStep), n};
  std::vector<Reach> found(length_ / kStep + 1);
  const auto placed = [&](std::ptrdiff_t i) -> Reach& { return found[static_cast<std::size_t>(i / kStep)]; };
  const auto high = [&](std::ptrdiff_t i) { return i < n ? placed(i).high : last; };
  placed(0) = search(t, 0, {0, last});
  std::ptrdiff_t stride = kStep;
  while (2 * stride < n) stride *= 2;
  for (; stride >= kStep; stride /= 2)
    for (std::ptrdiff_t i = stride; i < n; i += 2 * stride) placed(i) = search(t, i, {placed(i - stride).low, high(i + stride)});
  for (std::ptrdiff_t i = 0; i < n; i += kStep) fill_between(t, i, {placed(i).low, high(i + kStep)});
}

}  // namespace vantage
