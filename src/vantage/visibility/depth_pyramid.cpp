// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/depth_pyramid.h"

#include <algorithm>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr int kFirstShift = 2;
constexpr int kSpan = 3;  ///< Squares a side that a query looks at, at most.

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
DepthPyramid<Dim>::DepthPyramid(const DepthImage<Dim>& image) : image_(image) {
  const int columns = image.resolution(), rows = static_cast<int>(image.pixels_per_face()) / columns;
  const auto pixel = [&](std::size_t i) { return Bounds{image[i], image[i]}; };
  levels_.push_back(reduce(Level{0, columns, rows, {}}, 1 << kFirstShift, pixel));
  while (levels_.back().columns > 1) {
    const Level& fine = levels_.back();
    levels_.push_back(reduce(fine, 2, [&](std::size_t i) { return fine.squares[i]; }));
  }
}

template <int Dim>
  requires SpatialDim<Dim>
template <class Source>
typename DepthPyramid<Dim>::Level DepthPyramid<Dim>::reduce(const Level& fine, int factor, const Source& source) const {
  const auto coarse = [&](int n) { return (n + factor - 1) / factor; };
  Level level{fine.shift + (factor == 2 ? 1 : kFirstShift), coarse(fine.columns), coarse(fine.rows), {}};
  level.squares.resize(static_cast<std::size_t>(2 * Dim * level.rows * level.columns));
  parallel_for(static_cast<std::size_t>(2 * Dim * level.rows), 16, [&](std::size_t task) {
    const int face = static_cast<int>(task) / level.rows, row = static_cast<int>(task) % level.rows;
    Bounds* const out = level.squares.data() + task * static_cast<std::size_t>(level.columns);
    for (int r = row * factor; r < std::min(fine.rows, (row + 1) * factor); ++r) {
      const auto first = static_cast<std::size_t>(face * fine.rows + r) * static_cast<std::size_t>(fine.columns);
      const int whole = fine.columns / factor;
      for (int c = 0; c < whole; ++c)
        for (int k = 0; k < factor; ++k) out[c].extend(source(first + static_cast<std::size_t>(c * factor + k)));
      for (int c = whole * factor; c < fine.columns; ++c) out[whole].extend(source(first + static_cast<std::size_t>(c)));
    }
  });
  return level;
}

template <int Dim>
  requires SpatialDim<Dim>
typename DepthPyramid<Dim>::Bounds DepthPyramid<Dim>::over(int face, const typename DepthImage<Dim>::Rectangle& area) const {
  // In the plane a face is one row.
  const int top = (Dim - 2) * area.low[0], bottom = (Dim - 2) * (area.high[0] - 1), left = area.low[Dim - 2], right = area.high[Dim - 2] - 1;
  std::size_t l = 0;
  const auto fits = [&](int shift) { return (right >> shift) - (left >> shift) < kSpan && (bottom >> shift) - (top >> shift) < kSpan; };
  while (l + 1 < levels_.size() && !fits(levels_[l].shift)) ++l;
  const Level& level = levels_[l];
  Bounds out;
  for (int r = top >> level.shift; r <= bottom >> level.shift; ++r) {
    const Bounds* const row = level.squares.data() + static_cast<std::size_t>(face * level.rows + r) * static_cast<std::size_t>(level.columns);
    for (int c = left >> level.shift; c <= right >> level.shift; ++c) out.extend(row[c]);
  }
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
typename DepthPyramid<Dim>::Bounds DepthPyramid<Dim>::over(const Box<Dim>& box) const {
  Bounds out;
  for (int face = 0; face < 2 * Dim; ++face) {
    const auto area = image_.rectangle(face, box);
    if (!area.empty()) out.extend(over(face, area));
  }
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
std::size_t DepthPyramid<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) sum += level.squares.size() * sizeof(Bounds);
  return sum;
}

template class DepthPyramid<2>;
template class DepthPyramid<3>;

}  // namespace vantage
