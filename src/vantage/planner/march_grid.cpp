// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/march_grid.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

// Kept as nearness, kFar - distance, so that what is left out is 0.
constexpr auto kNearest = static_cast<std::uint8_t>(MarchGrid<2>::kFar);
constexpr int kLine = 16;  // Bytes that are worked on at once.
using Line [[gnu::vector_size(kLine)]] = std::uint8_t;

Line load(const std::uint8_t* from) {
  Line line;
  std::memcpy(&line, from, kLine);
  return line;
}
void store(const Line& line, std::uint8_t* to) { std::memcpy(to, &line, kLine); }
Line most(const Line& a, const Line& b) { return a > b ? a : b; }
/// Every byte less by `steps`, but not below 0.
Line farther(const Line& line, const Line& steps) { return most(line, steps) - steps; }

/// Every byte moved up by `by` places, or down if that is negative; 0 comes in.
template <int by, int... i>
Line moved(const Line& line, std::integer_sequence<int, i...>) {
  return __builtin_shufflevector(line, Line{}, (i >= by && i - by < kLine ? i - by : kLine)...);
}
template <int by>
Line spread(const Line& line) {
  return most(line, moved<by>(farther(line, Line{} + static_cast<std::uint8_t>(by > 0 ? by : -by)), std::make_integer_sequence<int, kLine>()));
}
/// Along a row, up (side 1) or down (-1): no byte less than the one before less 1. `last`: of the line before; becomes that of this.
template <int side>
Line along(Line line, std::uint8_t& last) {
  constexpr Line kUp{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}, kDown{16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1};
  line = spread<8 * side>(spread<4 * side>(spread<2 * side>(spread<side>(line))));
  line = most(line, farther(Line{} + last, side > 0 ? kUp : kDown));
  last = line[side > 0 ? kLine - 1 : 0];
  return line;
}

/// Nearness row by row (along axis 0), each row in a margin of 0 and filled up to whole lines.
template <int Dim>
struct Rows {
  explicit Rows(const Grid<Dim>& window)
      : grid(window),
        length(static_cast<std::size_t>(window.extent[0])),
        filled((length + kLine) / kLine * kLine),
        bytes(window.size() / length * (filled + kLine) + kLine) {}
  [[nodiscard]] std::uint8_t* row(std::size_t number) { return bytes.data() + kLine + number * (filled + kLine); }
  [[nodiscard]] std::size_t count() const { return grid.size() / length; }

  Grid<Dim> grid;
  std::size_t length, filled;
  std::vector<std::uint8_t> bytes;
};

/// The most of the rows that touch the one through `node` and come before it in their order (side 1) or behind (-1), node by node.
template <int Dim>
void most_of_touching(Rows<Dim>& rows, const Index<Dim>& node, int side, std::uint8_t* out) {
  std::fill_n(out, rows.filled, std::uint8_t{0});
  int neighbours = 1;
  for (int a = 1; a < Dim; ++a) neighbours *= 3;
  for (int code = 0; code < neighbours / 2; ++code) {
    Index<Dim> other = node;
    for (int a = 1, rest = code; a < Dim; ++a, rest /= 3) other[a] += side * (rest % 3 - 1);
    if (!rows.grid.inside(other)) continue;
    const std::uint8_t* row = rows.row(rows.grid.linear(other) / rows.length);
    for (std::size_t k = 0; k < rows.filled; k += kLine) store(most(load(out + k), load(row + k)), out + k);
  }
}

/// One pass of the chessboard distance (Rosenfeld and Pfaltz 1966): every node at most one farther than those around it that come before.
template <int side, int Dim>
void sweep(Rows<Dim>& rows) {
  std::vector<std::uint8_t> buffer(rows.filled + 2 * kLine);
  std::uint8_t* around = buffer.data() + kLine;
  const Line one = Line{} + 1;
  for (std::size_t r = 0; r < rows.count(); ++r) {
    const std::size_t number = side > 0 ? r : rows.count() - 1 - r;
    std::uint8_t* row = rows.row(number);
    most_of_touching(rows, rows.grid.local(number * rows.length), side, around);
    std::uint8_t last = 0;
    for (std::size_t i = 0; i < rows.filled; i += kLine) {
      const std::size_t k = side > 0 ? i : rows.filled - kLine - i;
      const Line three = most(load(around + k), most(load(around + k - 1), load(around + k + 1)));
      store(along<side>(most(load(row + k), farther(three, one)), last), row + k);
    }
    std::fill(row + rows.length, row + rows.filled, std::uint8_t{0});
  }
}

template <int Dim>
Rows<Dim> nearness_rows(const Field<Dim, NodeState>& states, NodeState state) {
  Rows<Dim> rows(states.window);
  for (std::size_t r = 0; r < rows.count(); ++r) {
    const NodeState* from = states.values.data() + r * rows.length;
    std::uint8_t* row = rows.row(r);
    for (std::size_t k = 0; k < rows.length; ++k) row[k] = from[k] == state ? std::uint8_t{0} : kNearest;
  }
  sweep<1>(rows);
  sweep<-1>(rows);
  return rows;
}

}  // namespace

template <int Dim>
Field<Dim, std::uint8_t> chessboard_distance(const Field<Dim, NodeState>& states, NodeState state) {
  Field<Dim, std::uint8_t> distance(states.window);
  Rows<Dim> rows = nearness_rows(states, state);
  for (std::size_t r = 0; r < rows.count(); ++r)
    std::transform(rows.row(r), rows.row(r) + rows.length, distance.values.data() + r * rows.length,
                   [](std::uint8_t near) { return static_cast<std::uint8_t>(kNearest - near); });
  return distance;
}

template <int Dim>
  requires SpatialDim<Dim>
MarchGrid<Dim>::MarchGrid(const Field<Dim, NodeState>& state) : window_(state.window) {
  std::uint32_t step = 1;  // Blocks before the next along an axis.
  for (std::size_t a = 0; a < Dim; ++a) {
    const auto nodes = static_cast<std::uint32_t>(window_.extent[static_cast<int>(a)]);
    for (std::uint32_t i = 0; i < nodes; ++i) {
      std::uint32_t inner = i % kSide;
      for (std::size_t b = 0; b < a; ++b) inner *= kSide;
      offset_[a].push_back(i / kSide * step * 64 + inner);
    }
    offset_[a].push_back(offset_[a].back());
    step *= (nodes + kSide - 1) / kSide;
  }
  codes_.resize(std::size_t{step} * 64);
  std::array<std::unique_ptr<Rows<Dim>>, 2> rows;
  parallel_for(2, 1,
               [&](std::size_t i) { rows[i] = std::make_unique<Rows<Dim>>(nearness_rows(state, i == 0 ? NodeState::seen : NodeState::unseen)); });
  const std::size_t length = rows[0]->length;
  parallel_for(rows[0]->count(), 256, [&](std::size_t r) {
    const Index<Dim> node = window_.local(r * length);
    std::size_t place = 0;
    for (std::size_t a = 1; a < Dim; ++a) place += offset_[a][static_cast<std::size_t>(node[static_cast<int>(a)])];
    const NodeState* from = state.values.data() + r * length;
    const std::uint8_t *seen = rows[0]->row(r), *unseen = rows[1]->row(r);
    for (std::size_t k = 0; k < length; ++k) {
      const int distance = std::max(1, 2 * kNearest - seen[k] - unseen[k]);  // At least one of them is 0.
      codes_[place + offset_[0][k]] = static_cast<std::uint8_t>(static_cast<int>(from[k]) << 6 | distance);
    }
  });
}

template <int Dim>
  requires SpatialDim<Dim>
bool MarchGrid<Dim>::grown_from(const MarchGrid& before) const {
  if (!(before.window_ == window_)) return false;
  return parallel_reduce(
             codes_.size(), std::size_t{1} << 18, 1,
             [&](std::size_t begin, std::size_t end) {
               int grown = 1;
               for (std::size_t i = begin; i < end; ++i) grown &= codes_[i] >> 6 >= before.codes_[i] >> 6 ? 1 : 0;
               return grown;
             },
             [](int& all, int part) { all &= part; }) != 0;
}

template class MarchGrid<2>;
template class MarchGrid<3>;
template Field<2, std::uint8_t> chessboard_distance<2>(const Field<2, NodeState>&, NodeState);
template Field<3, std::uint8_t> chessboard_distance<3>(const Field<3, NodeState>&, NodeState);

}  // namespace vantage
