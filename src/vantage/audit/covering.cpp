// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/covering.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {
namespace {

constexpr double kRatio = 1.001;   ///< Upper over lower bound.
constexpr double kOnEdge = 1e-9;   ///< Of a triangle's size: so little outside is inside, or the seams of a fan would be holes.
constexpr double kSliver = 1e-12;  ///< A polygon of less area than this share of its squared length is its edges.

template <int Dim>
double segment_distance2(const Vec<Dim>& a, const Vec<Dim>& b, const Vec<Dim>& p) {
  const Vec<Dim> along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).squaredNorm();
}

/// Place of a patch with the point nearest to it.
template <int Dim>
struct Corner {
  Vec<Dim> place;
  std::uint32_t nearest = 0;
  double distance = 0.0;
};

/// Point, segment or triangle of a patch.
template <int Dim>
struct Piece {
  std::array<Corner<Dim>, 3> corners;
  int count = 0;
  double high = 0.0;  ///< No place of the piece is farther from the points.
};

template <int Dim>
class Halving {
 public:
  Halving(std::span<const Vec<Dim>> points, const BoxTree<Dim>& tree) : points_(points), tree_(tree) {}

  Covering run(const Patch<Dim>& patch) {
    std::vector<Corner<Dim>> corners;
    for (const Vec<Dim>& v : patch.corners()) {
      corners.push_back(corner(v, std::span<const Corner<Dim>>(corners)));
      tiny_ = std::max(tiny_, 1e-14 * v.template lpNorm<Eigen::Infinity>());
    }
    if (patch.count <= 2) push({{corners[0], corners[patch.count - 1], {}}, patch.count});
    for (int i = 1; i + 1 < patch.count; ++i) push({{corners[0], corners[i], corners[i + 1]}, 3});
    while (!open_.empty()) {
      const Piece<Dim> piece = open_.back();
      open_.pop_back();
      if (settled(piece))
        high_ = std::max(high_, piece.high);
      else
        halve(piece);
    }
    return {low_, std::max(low_, high_)};
  }

 private:
  [[nodiscard]] bool settled(const Piece<Dim>& piece) const { return piece.count == 1 || piece.high <= std::max(kRatio * low_, low_ + tiny_); }

  /// What is nearest to places near by is a good guess.
  Corner<Dim> corner(const Vec<Dim>& place, std::span<const Corner<Dim>> near) {
    typename BoxTree<Dim>::Hit start;
    for (const Corner<Dim>& other : near)
      if (const double d2 = (points_[other.nearest] - place).squaredNorm(); d2 < start.distance2) start = {d2, other.nearest};
    const auto hit = tree_.nearest(place, start, [&](std::uint32_t i) { return (points_[i] - place).squaredNorm(); });
    const double distance = std::sqrt(hit.distance2);
    low_ = std::max(low_, distance);
    return {place, hit.item, distance};
  }

  void push(Piece<Dim> piece) {
    double best2 = kInfinity;  // The distance to one point is convex, so largest at a corner.
    for (int c = 0; c < piece.count; ++c) {
      double farthest2 = 0.0;
      for (int v = 0; v < piece.count; ++v)
        farthest2 = std::max(farthest2, (piece.corners[v].place - points_[piece.corners[c].nearest]).squaredNorm());
      best2 = std::min(best2, farthest2);
    }
    piece.high = std::sqrt(best2);
    open_.push_back(piece);
  }

  void halve(const Piece<Dim>& piece) {
    int a = 0, b = 1;
    for (int i = 0; i < piece.count; ++i)
      for (int j = i + 1; j < piece.count; ++j)
        if ((piece.corners[i].place - piece.corners[j].place).squaredNorm() > (piece.corners[a].place - piece.corners[b].place).squaredNorm())
          a = i, b = j;
    const Corner<Dim> middle =
        corner(0.5 * (piece.corners[a].place + piece.corners[b].place), std::span(piece.corners).first(static_cast<std::size_t>(piece.count)));
    Piece<Dim> first = piece, second = piece;
    first.corners[b] = middle;
    second.corners[a] = middle;
    push(first);
    push(second);
    if (open_.back().high < open_[open_.size() - 2].high) std::swap(open_.back(), open_[open_.size() - 2]);  // The worse one next.
  }

  std::span<const Vec<Dim>> points_;
  const BoxTree<Dim>& tree_;
  std::vector<Piece<Dim>> open_;
  double low_ = 0.0, high_ = 0.0, tiny_ = 0.0;
};

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
FlatPiece<Dim>::FlatPiece(const Patch<Dim>& patch) : u_(Vec<Dim>::Zero()), w_(Vec<Dim>::Zero()) {
  if (patch.count < 3) return;
  const Vec<Dim>& origin = patch.vertices[0];
  double area = 0.0, length2 = 0.0;  // Of the triangle with the longest first side, the widest.
  for (int i = 1; i < patch.count; ++i) {
    const Vec<Dim> side = patch.vertices[i] - origin;
    if (side.squaredNorm() > length2) length2 = side.squaredNorm(), u_ = side;
  }
  if (!(length2 > 0.0)) return;
  u_.normalize();
  for (int i = 1; i < patch.count; ++i) {
    const Vec<Dim> side = patch.vertices[i] - origin, across = side - u_ * u_.dot(side);
    if (across.norm() * std::sqrt(length2) > area) area = across.norm() * std::sqrt(length2), w_ = across;
  }
  inside_ = area > kSliver * length2;
  if (inside_) w_ = (w_ - u_ * u_.dot(w_)).normalized();
}

template <int Dim>
  requires SpatialDim<Dim>
double FlatPiece<Dim>::distance2(const Patch<Dim>& patch, const Vec<Dim>& p) const {
  if (patch.count == 1) return (p - patch.vertices[0]).squaredNorm();
  if (patch.count == 2) return segment_distance2<Dim>(patch.vertices[0], patch.vertices[1], p);
  double least = kInfinity;
  for (int i = 0; i < patch.count; ++i) least = std::min(least, segment_distance2<Dim>(patch.vertices[i], patch.vertices[(i + 1) % patch.count], p));
  const Vec<Dim> to = p - patch.vertices[0];
  const Vec<2> foot = in_plane(to);
  if (!is_inside(patch, foot)) return least;
  return std::min(least, (to - u_ * foot[0] - w_ * foot[1]).squaredNorm());
}

/// In a triangle of the fan? Not left of every edge: polygons may have edges so short that their direction is chance.
template <int Dim>
  requires SpatialDim<Dim>
bool FlatPiece<Dim>::is_inside(const Patch<Dim>& patch, const Vec<2>& foot) const {
  const auto cross = [](const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; };
  for (int i = 1; inside_ && i + 1 < patch.count; ++i) {
    const Vec<2> b = in_plane(patch.vertices[i] - patch.vertices[0]), c = in_plane(patch.vertices[i + 1] - patch.vertices[0]);
    const double area = cross(b, c);
    if (!(std::abs(area) > kSliver * std::max(b.squaredNorm(), c.squaredNorm()))) continue;  // Its edges will do.
    const double s = cross(foot, c) / area, t = cross(b, foot) / area;
    if (s >= -kOnEdge && t >= -kOnEdge && s + t <= 1.0 + kOnEdge) return true;
  }
  return false;
}

template <int Dim>
Covering covering_of(const Patch<Dim>& patch, std::span<const Vec<Dim>> points, const BoxTree<Dim>& tree) {
  if (points.empty()) return {kInfinity, kInfinity};
  return Halving<Dim>(points, tree).run(patch);
}

template class FlatPiece<2>;
template class FlatPiece<3>;
template Covering covering_of<2>(const Patch<2>&, std::span<const Vec<2>>, const BoxTree<2>&);
template Covering covering_of<3>(const Patch<3>&, std::span<const Vec<3>>, const BoxTree<3>&);

}  // namespace vantage
