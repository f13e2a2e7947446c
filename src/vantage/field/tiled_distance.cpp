// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/tiled_distance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "vantage/base/parallel.h"
#include "vantage/field/line_minimum.h"

namespace vantage {
namespace {

using Bits = std::vector<std::uint64_t>;

constexpr std::size_t kTiles = 4;  ///< Tiles read and written together, so that memory comes in runs.

/// One bit a node of a row; bits past the end are 0.
void pack(const std::uint8_t* row, std::size_t length, Bits& bits) {
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
std::size_t find(const Bits& bits, std::size_t length, std::size_t from, bool value) {
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

/// Distance to the nearest node of a set: how a line of the first axis comes from its bits, how other lines go on, how squares become distances.
class Towards {
 public:
  using Value = float;

  template <int Dim>
  Towards(const Grid<Dim>& window, double cap) : spacing_(window.spacing), cap_(cap) {
    length_ = static_cast<std::size_t>(window.extent[0]);
    ramps_.emplace(length_, length_, kFarSquare);
    // Most distances are short: their roots are looked up.
    const double longest = window.extent.template cast<double>().squaredNorm();
    for (std::size_t s = 0; s < std::min<std::size_t>(1 << 16, static_cast<std::size_t>(longest) + 1); ++s)
      roots_.push_back(distance(static_cast<float>(s)));
  }
  void line(const Bits& bits, float* row) const {
    for (std::size_t from = 0; from < length_;) {
      const std::size_t site = find(bits, length_, from, true);
      if (site > from) ramps_->fill(row, from, site, length_);
      from = find(bits, length_, site, false);
      std::fill(row + site, row + from, 0.0F);
    }
  }
  [[nodiscard]] LineMinimum kernel(std::size_t length) const { return LineMinimum(length); }
  void write(const float* from, float* to, std::size_t count) const {
    const auto known = static_cast<float>(roots_.size());
    for (std::size_t k = 0; k < count; ++k) to[k] = from[k] < known ? roots_[static_cast<std::size_t>(from[k])] : distance(from[k]);
  }

 private:
  [[nodiscard]] float distance(float square) const {
    return static_cast<float>(square >= kFarSquare ? cap_ : std::min(cap_, std::sqrt(static_cast<double>(square)) * spacing_));
  }

  std::size_t length_ = 0;
  double spacing_, cap_;
  std::optional<Ramps<float>> ramps_;
  std::vector<float> roots_;
};

/// The same for both sides of a boundary.
class Across {
 public:
  using Value = std::int16_t;

  template <int Dim>
  Across(const Grid<Dim>& window, double cap)
      : length_(static_cast<std::size_t>(window.extent[0])),
        limit_(static_cast<int>(signed_reach(window.spacing, cap))),
        ramps_(length_, static_cast<std::size_t>(limit_), static_cast<std::int16_t>(limit_ * limit_)) {
    const double h = window.spacing, half = 0.5 * h;
    const int last = limit_ * limit_;
    for (int s = -last; s <= last; ++s) {
      const auto d = static_cast<float>(std::min(cap + half, std::sqrt(static_cast<double>(std::abs(s))) * h));
      distances_.push_back(s > 0 ? static_cast<float>(d - half) : static_cast<float>(half - d));
    }
  }
  void line(const Bits& bits, std::int16_t* row) const {
    for (std::size_t from = 0; from < length_;) {
      const bool side = (bits[from / 64] >> (from % 64) & 1U) != 0;
      const std::size_t end = find(bits, length_, from, !side);
      ramps_.fill(row, from, end, length_);
      for (std::size_t i = from; i < end && !side; ++i) row[i] = static_cast<std::int16_t>(-row[i]);
      from = end;
    }
  }
  [[nodiscard]] SignedLineMinimum kernel(std::size_t length) const { return SignedLineMinimum(length); }
  void write(const std::int16_t* from, float* to, std::size_t count) const {
    const float* zero = distances_.data() + distances_.size() / 2;
    for (std::size_t k = 0; k < count; ++k) to[k] = zero[from[k]];
  }

 private:
  std::size_t length_;
  int limit_;  // Squares of limit and beyond are all limit^2: at the cap.
  Ramps<std::int16_t> ramps_;
  std::vector<float> distances_;  // Of every square from -limit^2 to limit^2 [m].
};

/// `count` values, at most kLanes; whole tiles without a call.
template <class Value>
void copy_lanes(const Value* from, Value* to, std::size_t count) {
  if (count == kLanes) {
    std::memcpy(to, from, kLanes * sizeof(Value));
  } else {
    std::copy_n(from, count, to);
  }
}

/// A block of `length` rows of `stride` nodes.
struct Shape {
  std::size_t stride, length;
};

/// Another axis of a block: the first of `work` tile by tile, the second writes the rows, (from, to, count).
template <class Value, class Out, class Minimum, class Write>
void later_pass(const Value* source, Out* target, const Shape& shape, const std::pair<Minimum, Write>& work) {
  parallel_chunks(shape.stride, kTiles * kLanes, [&](std::size_t begin, std::size_t end) {
    const std::size_t tiles = (end - begin + kLanes - 1) / kLanes, size = shape.length * kLanes;
    std::vector<Value> in(tiles * size), out(tiles * size);
    const auto each_row = [&](auto&& body) {
      for (std::size_t i = 0; i < shape.length; ++i)
        for (std::size_t t = 0; t < tiles; ++t) {
          const std::size_t from = begin + t * kLanes;
          body(i * shape.stride + from, t * size + i * kLanes, std::min(kLanes, end - from));
        }
    };
    each_row([&](std::size_t node, std::size_t lane, std::size_t count) {
      copy_lanes(source + node, in.data() + lane, count);
      for (std::size_t idle = count; idle < kLanes; ++idle) in[lane + idle] = in[lane + count - 1];  // They do as their neighbour does.
    });
    for (std::size_t t = 0; t < tiles; ++t) work.first(in.data() + t * size, out.data() + t * size);
    each_row([&](std::size_t node, std::size_t lane, std::size_t count) { work.second(out.data() + lane, target + node, count); });
  });
}

/// All axes: the first two plane by plane while it is in the cache, the others one after another; the last writes `out`. `squares` may be `out`.
template <int Dim, class Rule>
void all_passes(const Field<Dim, std::uint8_t>& set, const Rule& rule, typename Rule::Value* squares, float* out) {
  using Value = typename Rule::Value;
  const Grid<Dim>& grid = set.window;
  if (grid.size() == 0) return;
  const auto pass = [&](int axis, std::size_t block) {
    const Shape shape{grid.stride(axis), static_cast<std::size_t>(grid.extent[axis])};
    const std::size_t at = block * shape.stride * shape.length;
    const auto minimum = rule.kernel(shape.length);
    if (axis == Dim - 1) {
      const auto write = [&](const Value* from, float* to, std::size_t count) { rule.write(from, to, count); };
      later_pass(squares + at, out + at, shape, std::pair(minimum, write));
    } else {
      later_pass(squares + at, squares + at, shape, std::pair(minimum, &copy_lanes<Value>));
    }
  };
  const auto width = static_cast<std::size_t>(grid.extent[0]), height = static_cast<std::size_t>(grid.extent[1]);
  parallel_for(grid.size() / (width * height), 1, [&](std::size_t z) {
    const std::size_t first_row = z * height;
    parallel_chunks(height, 64, [&](std::size_t begin, std::size_t end) {
      Bits bits;
      for (std::size_t row = first_row + begin; row < first_row + end; ++row) {
        pack(set.values.data() + row * width, width, bits);
        rule.line(bits, squares + row * width);
      }
    });
    pass(1, z);
  });
  for (int axis = 2; axis < Dim; ++axis)
    for (std::size_t b = 0; b < grid.size() / (grid.stride(axis) * static_cast<std::size_t>(grid.extent[axis])); ++b) pass(axis, b);
}

}  // namespace

double signed_reach(double spacing, double cap) { return std::floor(cap / spacing + 0.5) + 1.0; }

template <int Dim>
  requires SpatialDim<Dim>
bool exact_in_float(const Grid<Dim>& window) {
  return window.extent.template cast<double>().squaredNorm() < kExactSquare;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> tiled_distance(const Field<Dim, std::uint8_t>& set, double cap) {
  Field<Dim> out(set.window);
  all_passes(set, Towards(set.window, cap), out.values.data(), out.values.data());
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> tiled_signed_distance(const Field<Dim, std::uint8_t>& inside, double cap) {
  Field<Dim, std::int16_t> squares(inside.window);
  Field<Dim> out(inside.window);
  all_passes(inside, Across(inside.window, cap), squares.values.data(), out.values.data());
  return out;
}

#define VANTAGE_INSTANTIATE(D)                                                     \
  template bool exact_in_float<D>(const Grid<D>&);                                 \
  template Field<D> tiled_distance<D>(const Field<D, std::uint8_t>&, double); \
  template Field<D> tiled_signed_distance<D>(const Field<D, std::uint8_t>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
