// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/squared_distance.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "vantage/base/parallel.h"
#include "vantage/field/line_minimum.h"

namespace vantage {
namespace {

constexpr std::size_t kTiles = 4;  ///< Tiles read and written together, so that memory comes in runs.

/// One bit a node of a row; bits past the end are 0.
void pack(const std::uint8_t* row, std::size_t length, std::vector<std::uint64_t>& bits) {
  bits.assign((length + 63) / 64, 0);
  for (std::size_t i = 0; i < length; i += 8) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, row + i, std::min<std::size_t>(8, length - i));
    if (bytes == 0) continue;
    constexpr std::uint64_t kLow = 0x7F7F7F7F7F7F7F7FU;
    const std::uint64_t set = (((bytes & kLow) + kLow) | bytes) & ~kLow;  // The high bit of every byte that is not 0.
    bits[i / 64] |= ((set >> 7) * 0x0102040810204080U >> 56) << (i % 64);
  }
}

/// First place at or after `from` whose bit is `value`, or `length`.
std::size_t find(const std::vector<std::uint64_t>& bits, std::size_t length, std::size_t from, bool value) {
  const std::uint64_t flip = value ? 0 : ~std::uint64_t{0};
  for (std::size_t word = from / 64; word < bits.size(); ++word) {
    std::uint64_t rest = bits[word] ^ flip;
    if (word == from / 64) rest &= ~std::uint64_t{0} << (from % 64);
    if (rest != 0) return std::min(length, word * 64 + static_cast<std::size_t>(std::countr_zero(rest)));
  }
  return length;
}

/// Squares of the distance to the ends of a gap, copied from tables.
template <class Value>
class Ramps {
 public:
  /// Squares of steps beyond `limit` are `far`.
  Ramps(std::size_t length, std::size_t limit, Value far) : far_(far) {
    for (std::size_t k = 0; k <= length; ++k) up_.push_back(k <= limit ? static_cast<Value>(k * k) : far);
    down_.assign(up_.rbegin(), up_.rend());
  }
  /// Nodes [begin, end) of `row`, whose nearest others are begin - 1 and end, where there are such.
  void fill(Value* row, std::size_t begin, std::size_t end, std::size_t length) const {
    const bool before = begin > 0, after = end < length;
    if (!before && !after) return std::fill(row, row + length, far_);
    const std::size_t middle = !before ? begin : !after ? end : begin + (end - begin + 1) / 2;
    std::copy_n(up_.data() + 1, middle - begin, row + begin);
    std::copy_n(down_.data() + (down_.size() - 1 - (end - middle)), end - middle, row + middle);
  }

 private:
  Value far_;
  std::vector<Value> up_, down_;  // k^2 from 0 on; the same backwards.
};

/// The first axis: lines come from the bits of the set, `line(bits, row)`.
template <class Value, class Line>
void first_pass(const std::uint8_t* set, Value* out, std::size_t length, std::size_t lines, const Line& line) {
  parallel_chunks(lines, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t> bits;
    for (std::size_t k = begin; k < end; ++k) {
      pack(set + k * length, length, bits);
      line(bits, out + k * length);
    }
  });
}

/// Another axis of a block of `length` rows of `stride` nodes: `minimum` tile by tile.
template <class Value, class Minimum>
void later_pass(Value* block, std::size_t stride, std::size_t length, const Minimum& minimum) {
  constexpr std::size_t kWidth = kTiles * kLanes;
  parallel_chunks(stride, kWidth, [&](std::size_t begin, std::size_t end) {
    const std::size_t tiles = (end - begin + kLanes - 1) / kLanes, size = length * kLanes;
    std::vector<Value> in(tiles * size), out(size);
    for (std::size_t i = 0; i < length; ++i)
      for (std::size_t t = 0; t < tiles; ++t) {
        const std::size_t from = begin + t * kLanes, count = std::min(kLanes, end - from);
        Value* row = in.data() + t * size + i * kLanes;
        std::copy_n(block + i * stride + from, count, row);
        std::fill(row + count, row + kLanes, row[count - 1]);  // Idle lanes do as their neighbour does.
      }
    for (std::size_t t = 0; t < tiles; ++t) {
      minimum(in.data() + t * size, out.data());
      std::copy(out.begin(), out.end(), in.begin() + static_cast<std::ptrdiff_t>(t * size));
    }
    for (std::size_t i = 0; i < length; ++i)
      for (std::size_t t = 0; t < tiles; ++t) {
        const std::size_t from = begin + t * kLanes, count = std::min(kLanes, end - from);
        std::copy_n(in.data() + t * size + i * kLanes, count, block + i * stride + from);
      }
  });
}

/// All axes: the first two plane by plane while it is in the cache, the others one after another.
template <class Kernel, int Dim, class Value, class Line, class... Limit>
void all_passes(const Field<Dim, std::uint8_t>& set, Field<Dim, Value>& out, const Line& line, Limit... limit) {
  const Grid<Dim>& grid = set.window;
  if (grid.size() == 0) return;
  const auto width = static_cast<std::size_t>(grid.extent[0]), height = static_cast<std::size_t>(grid.extent[1]), plane = width * height;
  const Kernel second(height, limit...);
  parallel_for(grid.size() / plane, 1, [&](std::size_t z) {
    first_pass(set.values.data() + z * plane, out.values.data() + z * plane, width, height, line);
    later_pass(out.values.data() + z * plane, width, height, second);
  });
  for (int axis = 2; axis < Dim; ++axis) {
    const auto length = static_cast<std::size_t>(grid.extent[axis]);
    const std::size_t stride = grid.stride(axis), block = stride * length;
    const Kernel kernel(length, limit...);
    for (std::size_t b = 0; b < grid.size() / block; ++b) later_pass(out.values.data() + b * block, stride, length, kernel);
  }
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> squared_distances(const Field<Dim, std::uint8_t>& set) {
  Field<Dim> out(set.window);
  const auto length = static_cast<std::size_t>(set.window.extent[0]);
  const Ramps<float> ramps(length, length, kFarSquare);
  all_passes<LineMinimum>(set, out, [&](const std::vector<std::uint64_t>& bits, float* row) {
    for (std::size_t from = 0; from < length;) {
      const std::size_t site = find(bits, length, from, true);
      if (site > from) ramps.fill(row, from, site, length);
      from = find(bits, length, site, false);
      std::fill(row + site, row + from, 0.0F);
    }
  });
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim, std::int16_t> signed_squares(const Field<Dim, std::uint8_t>& inside, int limit) {
  Field<Dim, std::int16_t> out(inside.window);
  const auto length = static_cast<std::size_t>(inside.window.extent[0]);
  const Ramps<std::int16_t> ramps(length, kMaxLimit, kFarShort);
  all_passes<SignedLineMinimum>(
      inside, out,
      [&](const std::vector<std::uint64_t>& bits, std::int16_t* row) {
        for (std::size_t from = 0; from < length;) {
          const bool side = (bits[from / 64] >> (from % 64) & 1U) != 0;
          const std::size_t end = find(bits, length, from, !side);
          ramps.fill(row, from, end, length);
          if (!side) std::transform(row + from, row + end, row + from, [](std::int16_t v) { return static_cast<std::int16_t>(-v); });
          from = end;
        }
      },
      limit);
  return out;
}

#define VANTAGE_INSTANTIATE(D)                                                  \
  template Field<D> squared_distances<D>(const Field<D, std::uint8_t>&);        \
  template Field<D, std::int16_t> signed_squares<D>(const Field<D, std::uint8_t>&, int);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
