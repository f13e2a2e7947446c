// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/geometry/box.h"

namespace vantage::bench {

/// What any reconstruction is made of: a point, a segment, a triangle, or a solid box (its low and its high corner).
struct Piece {
  enum class Kind : std::uint8_t { point = 1, segment, triangle, box };
  std::array<Vec<3>, 3> at;
  Kind kind = Kind::point;

  [[nodiscard]] Box<3> bounds() const;
  [[nodiscard]] double distance(const Vec<3>& p) const;
};
using Soup = std::vector<Piece>;

[[nodiscard]] Piece point(const Vec<3>& p);
[[nodiscard]] Piece segment(const Vec<3>& a, const Vec<3>& b);
[[nodiscard]] Piece triangle(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c);
[[nodiscard]] Piece box(const Vec<3>& low, const Vec<3>& high);
/// A piece each.
[[nodiscard]] Soup pieces(std::span<const Vec<3>> points);
/// Triangles of a convex polygon, or the segment or point that one of two or one corners is.
void add_polygon(Soup& soup, std::span<const Vec<3>> corners);

/// Distances to a soup: a tree of boxes that knows nothing of the contenders' structures.
class Nearest {
 public:
  explicit Nearest(Soup soup);
  /// To the nearest piece, at most `cap` [m]. Thread-safe.
  [[nodiscard]] double distance(const Vec<3>& p, double cap = kInfinity) const;

 private:
  struct Node {
    Box<3> box;
    std::uint32_t first = 0, count = 0;  ///< Pieces of a leaf; count 0: children are the next node and the one at `first`.
  };
  Soup soup_;
  std::vector<Node> nodes_;
  std::uint32_t build(std::vector<std::uint32_t>& order, std::uint32_t begin, std::uint32_t end);
};

/// distance(p, cap) of each place.
[[nodiscard]] std::vector<double> distances(const Nearest& nearest, std::span<const Vec<3>> places, double cap = kInfinity);

}  // namespace vantage::bench
