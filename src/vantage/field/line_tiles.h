// SPDX-License-Identifier: Apache-2.0
// Lines as bits and tiles: what the passes of the distance transform share.
#pragma once
#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <vector>

#include "vantage/base/parallel.h"
#include "vantage/field/grid.h"
#include "vantage/field/line_minimum.h"

namespace vantage {

inline constexpr std::size_t kTiles = 4;  ///< Tiles read and written together, so that memory comes in runs.

using Bits = std::vector<std::uint64_t>;

/// One bit a node of a row; bits past the end are 0.
inline void pack_row(const std::uint8_t* row, std::size_t length, Bits& bits) {
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
[[nodiscard]] inline std::size_t find_bit(const Bits& bits, std::size_t length, std::size_t from, bool value) {
  const std::uint64_t flip = value ? 0 : ~std::uint64_t{0};
  for (std::size_t word = from / 64; word < bits.size(); ++word) {
    std::uint64_t rest = bits[word] ^ flip;
    if (word == from / 64) rest &= ~std::uint64_t{0} << (from % 64);
    if (rest != 0) return std::min(length, word * 64 + static_cast<std::size_t>(std::countr_zero(rest)));
  }
  return length;
}

/// Calls run(begin, end, set) for every stretch of a row of `length` nodes that is all set or all clear.
template <class Run>
void for_runs(const Bits& bits, std::size_t length, Run&& run) {
  for (std::size_t from = 0; from < length;) {
    const bool set = (bits[from / 64] >> (from % 64) & 1U) != 0;
    const std::size_t end = find_bit(bits, length, from, !set);
    run(from, end, set);
    from = end;
  }
}

/// Where the nodes [begin, end) of a gap stop being nearer, or as near, to begin - 1 than to `end`, if there are such nodes in a row of `length`.
[[nodiscard]] inline std::size_t middle_of_gap(std::size_t begin, std::size_t end, std::size_t length) {
  return begin == 0 ? begin : end == length ? end : begin + (end - begin + 1) / 2;
}

/// `count` values, at most kTileLanes; whole tiles without a call.
template <class Value>
void copy_lanes(const Value* from, Value* to, std::size_t count) {
  if (count == kTileLanes) {
    std::memcpy(to, from, kTileLanes * sizeof(Value));
  } else {
    std::copy_n(from, count, to);
  }
}

/// An axis as a block of `length` rows of `stride` nodes.
struct Shape {
  std::size_t stride, length;
};

/// The tiles of columns [begin, end) of a block: calls body(node, lane, count) for runs of at most kTileLanes neighbours, `lane` counting row by row
/// in tile after tile.
template <class Body>
void for_tile_rows(const Shape& shape, std::size_t begin, std::size_t end, Body&& body) {
  for (std::size_t i = 0; i < shape.length; ++i)
    for (std::size_t from = begin; from < end; from += kTileLanes)
      body(i * shape.stride + from, (from - begin) * shape.length + i * kTileLanes, std::min(kTileLanes, end - from));
}

[[nodiscard]] inline std::size_t tiles_in(std::size_t begin, std::size_t end) { return (end - begin + kTileLanes - 1) / kTileLanes; }

/// Values lane by lane, tile after tile, of columns [begin, end); not set at first.
template <class Value>
class Tiles {
 public:
  Tiles(const Shape& shape, std::size_t begin, std::size_t end)
      : size_(tiles_in(begin, end) * shape.length * kTileLanes), values_(std::make_unique_for_overwrite<Value[]>(size_)) {}
  /// Those of a block; idle lanes do as their neighbour does.
  void read(const Value* block, const Shape& shape, std::size_t begin, std::size_t end) {
    for_tile_rows(shape, begin, end, [&](std::size_t node, std::size_t lane, std::size_t count) {
      copy_lanes(block + node, data() + lane, count);
      for (std::size_t idle = count; idle < kTileLanes; ++idle) values_[lane + idle] = values_[lane + count - 1];
    });
  }
  [[nodiscard]] Value* data() { return values_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  std::unique_ptr<Value[]> values_;
};

/// Calls `line(bits, row)` for every row of `plane`, the z-th pair of axes 0 and 1, and `axis(a, block)` for every block of every later axis in turn;
/// a plane goes through its second axis while it is in the cache.
template <int Dim, class LineOf, class Axis>
void for_axes(const Grid<Dim>& grid, const std::uint8_t* set, LineOf&& line, Axis&& axis) {
  if (grid.size() == 0) return;
  const auto width = static_cast<std::size_t>(grid.extent[0]), height = static_cast<std::size_t>(grid.extent[1]);
  parallel_for(grid.size() / (width * height), 1, [&](std::size_t z) {
    parallel_chunks(height, 64, [&](std::size_t begin, std::size_t end) {
      Bits bits;
      for (std::size_t row = z * height + begin; row < z * height + end; ++row) {
        pack_row(set + row * width, width, bits);
        line(bits, row);
      }
    });
    axis(1, z);
  });
  for (int a = 2; a < Dim; ++a)
    for (std::size_t block = 0; block < grid.size() / (grid.stride(a) * static_cast<std::size_t>(grid.extent[a])); ++block) axis(a, block);
}

}  // namespace vantage
