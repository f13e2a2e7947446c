// SPDX-License-Identifier: Apache-2.0
#include "distance.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>

#include "vantage/base/parallel.h"

namespace vantage::bench {
namespace {

constexpr std::uint32_t kLeaf = 4;  ///< Pieces.

double to_segment(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b) {
  const Vec<3> along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

/// To the plane if the foot is inside, else to the nearest side.
double to_triangle(const Vec<3>& p, const std::array<Vec<3>, 3>& at) {
  const Vec<3> normal = (at[1] - at[0]).cross(at[2] - at[0]);
  const double area2 = normal.squaredNorm();
  bool inside = area2 > 0.0;
  for (std::size_t i = 0; inside && i < 3; ++i) {
    const Vec<3>& a = at[i];
    inside = (at[(i + 1) % 3] - a).cross(p - a).dot(normal) >= 0.0;
  }
  if (inside) return std::abs((p - at[0]).dot(normal)) / std::sqrt(area2);
  return std::min({to_segment(p, at[0], at[1]), to_segment(p, at[1], at[2]), to_segment(p, at[2], at[0])});
}

}  // namespace

Box<3> Piece::bounds() const {
  Box<3> b;
  const int corners = kind == Kind::box ? 2 : static_cast<int>(kind);
  for (int i = 0; i < corners; ++i) b.extend(at[static_cast<std::size_t>(i)]);
  return b;
}

double Piece::distance(const Vec<3>& p) const {
  switch (kind) {
    case Kind::point: return (p - at[0]).norm();
    case Kind::segment: return to_segment(p, at[0], at[1]);
    case Kind::triangle: return to_triangle(p, at);
    case Kind::box: return bounds().distance(p);
  }
  return kInfinity;
}

Piece point(const Vec<3>& p) { return {{p, p, p}, Piece::Kind::point}; }
Piece segment(const Vec<3>& a, const Vec<3>& b) { return {{a, b, b}, Piece::Kind::segment}; }
Piece triangle(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) { return {{a, b, c}, Piece::Kind::triangle}; }
Piece box(const Vec<3>& low, const Vec<3>& high) { return {{low, high, high}, Piece::Kind::box}; }

Soup pieces(std::span<const Vec<3>> points) {
  Soup soup;
  soup.reserve(points.size());
  for (const Vec<3>& p : points) soup.push_back(point(p));
  return soup;
}

void add_polygon(Soup& soup, std::span<const Vec<3>> corners) {
  if (corners.size() == 1) soup.push_back(point(corners[0]));
  if (corners.size() == 2) soup.push_back(segment(corners[0], corners[1]));
  for (std::size_t i = 2; i < corners.size(); ++i) soup.push_back(triangle(corners[0], corners[i - 1], corners[i]));
}

Nearest::Nearest(Soup soup) : soup_(std::move(soup)) {
  if (soup_.empty()) return;
  std::vector<std::uint32_t> order(soup_.size());
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(soup_.size());
  build(order, 0, static_cast<std::uint32_t>(order.size()));
  Soup sorted;
  sorted.reserve(soup_.size());
  for (const std::uint32_t i : order) sorted.push_back(soup_[i]);
  soup_ = std::move(sorted);
}

std::uint32_t Nearest::build(std::vector<std::uint32_t>& order, std::uint32_t begin, std::uint32_t end) {
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  Node node{{}, begin, end - begin};
  Box<3> centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Box<3> bounds = soup_[order[i]].bounds();
    node.box.extend(bounds);
    centers.extend(bounds.center());
  }
  nodes_.push_back(node);
  if (node.count <= kLeaf) return id;
  int axis = 0;
  centers.size().maxCoeff(&axis);
  const std::uint32_t middle = begin + node.count / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) { return soup_[a].bounds().center()[axis] < soup_[b].bounds().center()[axis]; });
  build(order, begin, middle);
  const std::uint32_t second = build(order, middle, end);
  nodes_[id].first = second;
  nodes_[id].count = 0;
  return id;
}

double Nearest::distance(const Vec<3>& p, double cap) const {
  struct Open {
    std::uint32_t node;
    double gap;
  };
  std::array<Open, 64> open;
  std::size_t depth = 0;
  if (!nodes_.empty()) open[depth++] = {0, nodes_[0].box.distance(p)};
  while (depth > 0) {
    const Open top = open[--depth];
    if (top.gap >= cap) continue;
    const Node& node = nodes_[top.node];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) cap = std::min(cap, soup_[i].distance(p));
    if (node.count > 0) continue;
    const Open left{top.node + 1, nodes_[top.node + 1].box.distance(p)}, right{node.first, nodes_[node.first].box.distance(p)};
    open[depth++] = left.gap < right.gap ? right : left;
    open[depth++] = left.gap < right.gap ? left : right;
  }
  return cap;
}

std::vector<double> distances(const Nearest& nearest, std::span<const Vec<3>> places, double cap) {
  std::vector<double> out(places.size());
  parallel_for(places.size(), 1024, [&](std::size_t i) { out[i] = nearest.distance(places[i], cap); });
  return out;
}

}  // namespace vantage::bench
