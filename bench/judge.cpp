// SPDX-License-Identifier: Apache-2.0
#include "judge.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage::bench {
namespace {

constexpr double kSpacing = 0.1;     ///< Between the places of a piece at which it is measured [m].
constexpr double kTolerance = 1e-3;  ///< Of the largest distance of a place [m].
constexpr double kWithin = 0.1;      ///< A true place counts as found [m].

Vec<3> middle(const Piece& piece) {
  switch (piece.kind) {
    case Piece::Kind::point: return piece.at[0];
    case Piece::Kind::triangle: return (piece.at[0] + piece.at[1] + piece.at[2]) / 3.0;
    default: return 0.5 * (piece.at[0] + piece.at[1]);
  }
}

/// Farthest place from the middle [m].
double radius(const Piece& piece) {
  const Vec<3> m = middle(piece);
  return std::max({(piece.at[0] - m).norm(), (piece.at[1] - m).norm(), piece.kind == Piece::Kind::triangle ? (piece.at[2] - m).norm() : 0.0});
}

/// Two halves across the longest side.
std::array<Piece, 2> halves(const Piece& piece) {
  if (piece.kind == Piece::Kind::box) {
    int axis = 0;
    (piece.at[1] - piece.at[0]).maxCoeff(&axis);
    Vec<3> cut_high = piece.at[1], cut_low = piece.at[0];
    cut_high[axis] = cut_low[axis] = 0.5 * (piece.at[0][axis] + piece.at[1][axis]);
    return {box(piece.at[0], cut_high), box(cut_low, piece.at[1])};
  }
  if (piece.kind == Piece::Kind::segment) return {segment(piece.at[0], middle(piece)), segment(middle(piece), piece.at[1])};
  std::size_t longest = 0;
  const auto side2 = [&](std::size_t i) { return (piece.at[(i + 1) % 3] - piece.at[i]).squaredNorm(); };
  for (std::size_t i = 1; i < 3; ++i)
    if (side2(i) > side2(longest)) longest = i;
  const Vec<3>&a = piece.at[longest], &b = piece.at[(longest + 1) % 3], &c = piece.at[(longest + 2) % 3];
  const Vec<3> cut = 0.5 * (a + b);
  return {triangle(a, cut, c), triangle(cut, b, c)};
}

/// Raises `best` to the largest distance of a place of the piece, or leaves it at most kTolerance below.
void raise(const Nearest& data, const Piece& piece, double& best) {
  const double gap = data.distance(middle(piece)), reach = radius(piece);
  best = std::max(best, gap);
  if (gap + reach <= best + kTolerance) return;
  for (const Piece& half : halves(piece)) raise(data, half, best);
}

/// Places all over the piece, at most about kSpacing apart.
void add_places(const Piece& piece, std::vector<Vec<3>>& places) {
  const double length = piece.kind == Piece::Kind::point ? 0.0
                        : piece.kind == Piece::Kind::box ? (piece.at[1] - piece.at[0]).maxCoeff()
                                                         : 2.0 * radius(piece);
  const int n = std::max(1, static_cast<int>(std::ceil(length / kSpacing - 1e-6)));
  const auto at = [&](double i) { return i / n; };
  if (piece.kind == Piece::Kind::box) {
    const Vec<3> size = piece.at[1] - piece.at[0];
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        for (int k = 0; k <= n; ++k) places.emplace_back(piece.at[0] + size.cwiseProduct(Vec<3>(at(i), at(j), at(k))));
  } else if (piece.kind == Piece::Kind::triangle) {
    const Vec<3> u = piece.at[1] - piece.at[0], v = piece.at[2] - piece.at[0];
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) places.emplace_back(piece.at[0] + at(i + 1.0 / 3.0) * u + at(j + 1.0 / 3.0) * v);
  } else {
    for (int i = 0; i < n; ++i) places.emplace_back(piece.at[0] + at(i + 0.5) * (piece.at[1] - piece.at[0]));
  }
}

/// Maximum, 99 % and mean of a sample.
Side summary(std::vector<double> values) {
  if (values.empty()) return {};
  double sum = 0.0;
  for (const double v : values) sum += v;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  const double p99 = *at;
  return {std::ranges::max(values), p99, sum / static_cast<double>(values.size())};
}

Side surface_side(const Soup& soup, const Nearest& data) {
  std::vector<Vec<3>> places;
  for (const Piece& piece : soup) add_places(piece, places);
  Side side = summary(distances(data, places));
  side.maximum = parallel_reduce(
      soup.size(), 4096, side.maximum,
      [&](std::size_t begin, std::size_t end) {
        double best = side.maximum;
        for (std::size_t i = begin; i < end; ++i) raise(data, soup[i], best);
        return best;
      },
      [](double& a, double b) { a = std::max(a, b); });
  return side;
}

double recall(const Nearest& surface, const std::vector<Vec<3>>& places) {
  std::size_t found = 0;
  for (const double gap : distances(surface, places, 2.0 * kWithin)) found += gap <= kWithin ? 1 : 0;
  return static_cast<double>(found) / static_cast<double>(std::max<std::size_t>(1, places.size()));
}

}  // namespace

Judge::Judge(const Scene<3>& scene, std::span<const Vec<3>> points)
    : points_(points), data_(pieces(points)), poles_(observed_places(scene, "pole", points)), wires_(observed_places(scene, "wire", points)) {}

Score Judge::score(const Soup& soup) const {
  const Nearest surface(soup);
  return {summary(distances(surface, points_)), surface_side(soup, data_), recall(surface, poles_), recall(surface, wires_)};
}

}  // namespace vantage::bench
