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
using Ints = std::int32_t __attribute__((vector_size(16)));
using Shorts = std::int16_t __attribute__((vector_size(16)));

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
constexpr std::size_t kStep = 4;  ///< Rows that the divide and conquer places; those between are searched together.

/// Smallest and largest nearest row over the lanes.
struct Reach {
  std::int32_t low, high;
};

/// What is common to one tile.
struct Tile {
  const float* in;
  float* out;
  const float* squares;  ///< Of 0; entry 4 k is k^2.
  std::ptrdiff_t length;
};

/// Largest over the lanes of the least of rows i, low and high as seen from i.
float upper_bound(const Tile& t, std::ptrdiff_t i, const Reach& reach) {
  const std::array<std::ptrdiff_t, 3> rows{std::clamp<std::ptrdiff_t>(i, reach.low, reach.high), reach.low, reach.high};
  float worst = 0.0F;
  for (std::size_t part = 0; part < kParts; ++part) {
    const auto seen = [&](std::ptrdiff_t j) { return load<Floats>(t.in + j * static_cast<std::ptrdiff_t>(kLanes) + 4 * part) + load<Floats>(t.squares + 4 * (j - i)); };
    Floats best = seen(rows[0]);
    for (const std::ptrdiff_t j : {rows[1], rows[2]}) {
      const Floats other = seen(j);
      best = other < best ? other : best;
    }
    for (int lane = 0; lane < 4; ++lane) worst = std::max(worst, best[lane]);
  }
  return worst;
}

/// Row i from the rows of `reach`, and where its lanes found their least (the first, if several).
Reach search(const Tile& t, std::ptrdiff_t i, Reach reach) {
  const auto radius = static_cast<std::int32_t>(std::ceil(std::sqrt(upper_bound(t, i, reach))));
  const auto row = static_cast<std::int32_t>(i);
  reach = {std::max(reach.low, row - radius), std::min(reach.high, row + radius)};
  std::array<Floats, kParts> best;
  std::array<Ints, kParts> from;
  best.fill(Floats{} + 2.0F * kFarSquare);
  from.fill(Ints{} + reach.low);
  Ints j = Ints{} + reach.low;
  const float* in = t.in + static_cast<std::size_t>(reach.low) * kLanes;
  for (std::int32_t k = reach.low - row; k <= reach.high - row; ++k, in += kLanes, j += 1) {
    const Floats square = load<Floats>(t.squares + 4 * k);
    for (std::size_t part = 0; part < kParts; ++part) {
      const Floats other = load<Floats>(in + 4 * part) + square;
      const Ints less = other < best[part];
      best[part] = other < best[part] ? other : best[part];
      from[part] = (less & j) | (~less & from[part]);
    }
  }
  Reach found{from[0][0], from[0][0]};
  for (std::size_t part = 0; part < kParts; ++part) {
    store(t.out + static_cast<std::size_t>(i) * kLanes + 4 * part, best[part]);
    for (int lane = 0; lane < 4; ++lane) {
      found.low = std::min(found.low, from[part][lane]);
      found.high = std::max(found.high, from[part][lane]);
    }
  }
  return found;
}

/// The rows after i, kStep - 1 of them, from the rows of `reach`.
void fill_between(const Tile& t, std::ptrdiff_t i, const Reach& reach) {
  const auto stride = static_cast<std::ptrdiff_t>(kLanes);
  for (std::size_t part = 0; part < kParts; ++part) {
    Floats a = Floats{} + 2.0F * kFarSquare, b = a, c = a;
    const float* in = t.in + reach.low * stride + 4 * part;
    const float* square = t.squares + 4 * (reach.low - i);
    for (std::int32_t j = reach.low; j <= reach.high; ++j, in += kLanes, square += 4) {
      const Floats value = load<Floats>(in);
      const Floats x = value + load<Floats>(square - 4), y = value + load<Floats>(square - 8), z = value + load<Floats>(square - 12);
      a = x < a ? x : a;
      b = y < b ? y : b;
      c = z < c ? z : c;
    }
    float* out = t.out + (i + 1) * stride + 4 * part;
    store(out, a);
    if (i + 2 < t.length) store(out + stride, b);
    if (i + 3 < t.length) store(out + 2 * stride, c);
  }
}

}  // namespace

LineMinimum::LineMinimum(std::size_t length) : length_(length) {
  const auto n = static_cast<std::ptrdiff_t>(length + kStep);
  for (std::ptrdiff_t k = -n; k <= n; ++k) squares_.insert(squares_.end(), 4, static_cast<float>(k * k));
}

void LineMinimum::operator()(const float* tile, float* out) const {
  const auto n = static_cast<std::ptrdiff_t>(length_), step = static_cast<std::ptrdiff_t>(kStep);
  const Tile t{tile, out, squares_.data() + 4 * (n + step), n};
  const auto last = static_cast<std::int32_t>(n - 1);
  std::vector<Reach> found(length_ / kStep + 1);
  found[0] = search(t, 0, {0, last});
  std::ptrdiff_t stride = step;
  while (2 * stride < n) stride *= 2;
  for (; stride >= step; stride /= 2)
    for (std::ptrdiff_t i = stride; i < n; i += 2 * stride) {
      const std::int32_t low = found[static_cast<std::size_t>((i - stride) / step)].low;
      const std::int32_t high = i + stride < n ? found[static_cast<std::size_t>((i + stride) / step)].high : last;
      found[static_cast<std::size_t>(i / step)] = search(t, i, {low, high});
    }
  for (std::ptrdiff_t i = 0; i + 1 < n; i += step)
    fill_between(t, i, {found[static_cast<std::size_t>(i / step)].low, i + step < n ? found[static_cast<std::size_t>((i + step) / step)].high : last});
}

}  // namespace vantage
