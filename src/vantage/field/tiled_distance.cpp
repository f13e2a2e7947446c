// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/tiled_distance.h"

#include <cmath>

#include "vantage/field/line_tiles.h"

namespace vantage {
namespace {

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
    if (begin == 0 && end == length) return std::fill(row, row + length, far_);
    const std::size_t middle = middle_of_gap(begin, end, length);
    std::copy_n(up_.data() + 1, middle - begin, row + begin);
    std::copy_n(down_.data() + (down_.size() - 1 - (end - middle)), end - middle, row + middle);
  }

 private:
  Value far_;
  std::vector<Value> up_, down_;  // k^2 from 0 on; the same backwards.
};

/// Distance to the nearest node of a set: how a line of the first axis comes from its bits, how squares become distances.
template <class Real>
class Towards {
 public:
  using Value = Real;
  using Kernel = LineMinimum<Real>;

  template <int Dim>
  Towards(const Grid<Dim>& window, double cap)
      : length_(static_cast<std::size_t>(window.extent[0])), spacing_(window.spacing), cap_(cap), ramps_(length_, length_, kFarSquare<Real>) {
    constexpr double kTable = 65536.0;  // Most distances are short: their roots are looked up.
    const double longest = std::min(kTable, window.extent.template cast<double>().squaredNorm());
    for (double s = 0.0; s < longest; s += 1.0) roots_.push_back(distance(s));
  }
  void line(const Bits& bits, Real* row) const {
    for_runs(bits, length_, [&](std::size_t begin, std::size_t end, bool set) {
      if (set) return std::fill(row + begin, row + end, Real(0));
      ramps_.fill(row, begin, end, length_);
    });
  }
  void write(const Real* from, float* to, std::size_t count) const {
    const auto known = static_cast<Real>(roots_.size());
    for (std::size_t k = 0; k < count; ++k)
      to[k] = from[k] < known ? roots_[static_cast<std::size_t>(from[k])] : distance(static_cast<double>(from[k]));
  }

 private:
  [[nodiscard]] float distance(double square) const {
    return static_cast<float>(square >= static_cast<double>(kFarSquare<Real>) ? cap_ : std::min(cap_, std::sqrt(square) * spacing_));
  }

  std::size_t length_;
  double spacing_, cap_;
  Ramps<Real> ramps_;
  std::vector<float> roots_;
};

/// The same for both sides of a boundary.
class Across {
 public:
  using Value = std::int16_t;
  using Kernel = SignedLineMinimum;

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
    for_runs(bits, length_, [&](std::size_t begin, std::size_t end, bool set) {
      ramps_.fill(row, begin, end, length_);
      for (std::size_t i = begin; i < end && !set; ++i) row[i] = static_cast<std::int16_t>(-row[i]);
    });
  }
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

/// Another axis of a block: `kernel` tile by tile, `write(from, to, count)` for its rows.
template <class Value, class Out, class Kernel, class Write>
void later_pass(const Value* source, Out* target, const std::pair<Shape, Kernel>& axis, const Write& write) {
  const auto& [shape, kernel] = axis;
  parallel_chunks(shape.stride, kTiles * kTileLanes, [&](std::size_t begin, std::size_t end) {
    Tiles<Value> in(shape, begin, end), out(shape, begin, end);
    in.read(source, shape, begin, end);
    for (std::size_t at = 0; at < in.size(); at += shape.length * kTileLanes) kernel(in.data() + at, out.data() + at);
    for_tile_rows(shape, begin, end, [&](std::size_t node, std::size_t lane, std::size_t count) { write(out.data() + lane, target + node, count); });
  });
}

/// All axes; the last writes `out`, the others `squares`, which may be `out`.
template <int Dim, class Rule>
void all_passes(const Field<Dim, std::uint8_t>& set, const Rule& rule, typename Rule::Value* squares, float* out) {
  using Value = typename Rule::Value;
  const Grid<Dim>& grid = set.window;
  const auto width = static_cast<std::size_t>(grid.extent[0]);
  const auto line = [&](const Bits& bits, std::size_t row) { rule.line(bits, squares + row * width); };
  for_axes(grid, set.values.data(), line, [&](int axis, std::size_t block) {
    const Shape shape{grid.stride(axis), static_cast<std::size_t>(grid.extent[axis])};
    const std::size_t at = block * shape.stride * shape.length;
    const std::pair pass(shape, typename Rule::Kernel(shape.length));
    if (axis == Dim - 1) {
      later_pass(squares + at, out + at, pass, [&](const Value* from, float* to, std::size_t count) { rule.write(from, to, count); });
    } else {
      later_pass(squares + at, squares + at, pass, copy_lanes<Value>);
    }
  });
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
  if (exact_in_float(set.window)) {
    all_passes(set, Towards<float>(set.window, cap), out.values.data(), out.values.data());
  } else {
    Field<Dim, double> squares(set.window);
    all_passes(set, Towards<double>(set.window, cap), squares.values.data(), out.values.data());
  }
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

#define VANTAGE_INSTANTIATE(D)                                                \
  template bool exact_in_float<D>(const Grid<D>&);                            \
  template Field<D> tiled_distance<D>(const Field<D, std::uint8_t>&, double); \
  template Field<D> tiled_signed_distance<D>(const Field<D, std::uint8_t>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
