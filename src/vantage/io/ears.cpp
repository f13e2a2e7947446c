// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/ears.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace vantage {
namespace {

constexpr double kMostTests = 1e9;  ///< Of corners within ears, for one polygon; then its rest becomes a fan.

/// A corner of the ring that is left, seen in the plane.
struct Corner {
  std::uint32_t place;
  Vec<2> at;
  std::size_t before, after;
};

/// Twice the area of a, b, c; positive if they turn left.
double turn(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) { return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]); }

bool in_triangle(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& p) {
  return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

class EarCutter {
 public:
  EarCutter(std::span<const Vec<3>> places, std::span<const std::uint32_t> outline, std::vector<Mesh<3>::Facet>& out) : places_(places), out_(out) {
    Vec<3> normal = Vec<3>::Zero();
    const Vec<3>& first = places[outline[0]];
    for (std::size_t i = 2; i < outline.size(); ++i) normal += (places[outline[i - 1]] - first).cross(places[outline[i]] - first);
    flat_ = !(normal.norm() > 0.0);
    if (flat_) return;
    normal.normalize();
    int least = 0;
    normal.cwiseAbs().minCoeff(&least);
    axes_[0] = normal.cross(Vec<3>::Unit(least)).normalized();
    axes_[1] = normal.cross(axes_[0]);
    origin_ = first;
    start_ = link(outline, true);
  }
  [[nodiscard]] bool flat() const { return flat_ || !start_; }

  /// Joins the holes from left to right, so that each sees those before it as part of the outline.
  void join_holes(std::span<const std::span<const std::uint32_t>> rings) {
    std::vector<std::size_t> leftmost;
    for (const auto& ring : rings)
      if (const auto begin = link(ring, false)) leftmost.push_back(leftmost_of(*begin));
    std::sort(leftmost.begin(), leftmost.end(), [&](std::size_t i, std::size_t k) { return left_of(i, k) || (!left_of(k, i) && i < k); });
    for (const std::size_t hole : leftmost)
      if (const auto seen = bridge_end(hole)) join(*seen, hole);
  }

  void cut() {
    std::size_t left = 0, here = *start_;
    do ++left, here = ring_[here].after;
    while (here != *start_);
    // The ear is looked for at first behind the start, so that a convex polygon becomes a fan around its first corner.
    here = ring_[*start_].after;
    for (std::size_t looked = 0; left > 3 && looked < 2 * left && tests_ < kMostTests;) {
      const double area = turn_at(here);
      // The second time round, corners without an area of their own are dropped.
      const bool straight = looked >= left && area == 0.0;
      if (!straight && !(area > 0.0 && is_ear(here))) {
        here = ring_[here].after;
        ++looked;
        continue;
      }
      if (!straight) add(here);
      here = unlink(here);
      --left;
      looked = 0;
    }
    const std::size_t hub = ring_[here].before;
    for (; ring_[here].after != hub; here = ring_[here].after)
      if (left > 3 || turn_at(here) != 0.0) out_.push_back({ring_[hub].place, ring_[here].place, ring_[ring_[here].after].place});
  }

 private:
  [[nodiscard]] const Vec<2>& at(std::size_t i) const { return ring_[i].at; }
  [[nodiscard]] const Vec<2>& before(std::size_t i) const { return at(ring_[i].before); }
  [[nodiscard]] const Vec<2>& after(std::size_t i) const { return at(ring_[i].after); }
  [[nodiscard]] double turn_at(std::size_t i) const { return turn(before(i), at(i), after(i)); }
  [[nodiscard]] bool left_of(std::size_t i, std::size_t k) const { return at(i)[0] < at(k)[0] || (at(i)[0] == at(k)[0] && at(i)[1] < at(k)[1]); }

  /// A ring of its own, turning left or not; none if fewer than three corners differ from those before them.
  std::optional<std::size_t> link(std::span<const std::uint32_t> corners, bool to_left) {
    const std::size_t begin = ring_.size();
    for (const std::uint32_t place : corners) {
      if (ring_.size() > begin && ring_.back().place == place) continue;
      const Vec<3> v = places_[place] - origin_;
      ring_.push_back({place, {axes_[0].dot(v), axes_[1].dot(v)}, 0, 0});
    }
    while (ring_.size() > begin + 1 && ring_.back().place == ring_[begin].place) ring_.pop_back();
    const std::size_t count = ring_.size() - begin;
    if (count < 3) {
      ring_.resize(begin);
      return std::nullopt;
    }
    double area = 0.0;
    for (std::size_t i = 2; i < count; ++i) area += turn(at(begin), at(begin + i - 1), at(begin + i));
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t next = begin + (i + 1) % count, last = begin + (i + count - 1) % count;
      ring_[begin + i].after = (area > 0.0) == to_left ? next : last;
      ring_[begin + i].before = (area > 0.0) == to_left ? last : next;
    }
    return begin;
  }

  [[nodiscard]] std::size_t leftmost_of(std::size_t begin) const {
    std::size_t best = begin;
    for (std::size_t i = ring_[begin].after; i != begin; i = ring_[i].after)
      if (left_of(i, best)) best = i;
    return best;
  }

  /// Whether what lies from corner i towards p is inside of the ring close by.
  [[nodiscard]] bool opens_towards(std::size_t i, const Vec<2>& p) const {
    const bool first = turn(before(i), at(i), p) >= 0.0, second = turn(at(i), after(i), p) >= 0.0;
    return turn_at(i) > 0.0 ? first && second : first || second;
  }

  /// The corner of the outline that the hole's leftmost corner is joined to: an end of the first edge to its left, or a corner before it.
  [[nodiscard]] std::optional<std::size_t> bridge_end(std::size_t hole) const {
    const Vec<2>& h = at(hole);
    std::optional<std::size_t> best;
    double reached = -kInfinity;
    std::size_t i = *start_;
    do {
      const Vec<2>&a = at(i), &b = after(i);
      if (a[1] >= h[1] && h[1] >= b[1] && a[1] != b[1]) {
        const double x = a[0] + (h[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]);
        if (x <= h[0] && x > reached) {
          reached = x;
          best = a[0] < b[0] ? i : ring_[i].after;
        }
      }
      i = ring_[i].after;
    } while (i != *start_);
    if (!best || reached == h[0]) return best;
    return nearest_in_sight(hole, *best, reached);
  }

  /// Of the corners within the triangle between the hole, the edge's end and the place on the edge, the one nearest to level.
  [[nodiscard]] std::size_t nearest_in_sight(std::size_t hole, std::size_t end, double reached) const {
    const Vec<2>&h = at(hole), e = at(end), foot(reached, h[1]);
    const bool below = e[1] < h[1];
    std::size_t best = end, i = end;
    double least = kInfinity;
    do {
      const Vec<2>& p = at(i);
      if (p[0] >= e[0] && p[0] < h[0] && in_triangle(below ? h : foot, below ? foot : h, e, p) && opens_towards(i, h)) {
        const double slope = std::abs(h[1] - p[1]) / (h[0] - p[0]);
        if (slope < least || (slope == least && p[0] > at(best)[0])) least = slope, best = i;
      }
      i = ring_[i].after;
    } while (i != end);
    return best;
  }

  /// Outline .. a, hole .. hole, a .. outline: both ends of the bridge twice.
  void join(std::size_t a, std::size_t hole) {
    const std::size_t a2 = ring_.size(), hole2 = a2 + 1;
    ring_.push_back(ring_[a]);
    ring_.push_back(ring_[hole]);
    ring_[a2].before = hole2;
    ring_[ring_[a2].after].before = a2;
    ring_[hole2].after = a2;
    ring_[ring_[hole2].before].after = hole2;
    ring_[a].after = hole;
    ring_[hole].before = a;
  }

  [[nodiscard]] bool is_ear(std::size_t i) {
    const Corner &a = ring_[ring_[i].before], &b = ring_[i], &c = ring_[ring_[i].after];
    const Vec<2> low = a.at.cwiseMin(b.at).cwiseMin(c.at), high = a.at.cwiseMax(b.at).cwiseMax(c.at);
    for (std::size_t k = c.after; k != b.before; k = ring_[k].after) {
      tests_ += 1.0;
      const Corner& p = ring_[k];
      if (p.place == a.place || p.place == b.place || p.place == c.place || (p.at.array() < low.array()).any() || (p.at.array() > high.array()).any())
        continue;
      if (in_triangle(a.at, b.at, c.at, p.at) && turn_at(k) <= 0.0) return false;
    }
    return true;
  }

  void add(std::size_t i) { out_.push_back({ring_[ring_[i].before].place, ring_[i].place, ring_[ring_[i].after].place}); }

  /// Takes the corner out and returns the one behind it.
  std::size_t unlink(std::size_t i) {
    ring_[ring_[i].before].after = ring_[i].after;
    ring_[ring_[i].after].before = ring_[i].before;
    return ring_[i].after;
  }

  std::span<const Vec<3>> places_;
  std::vector<Mesh<3>::Facet>& out_;
  std::vector<Corner> ring_;
  std::optional<std::size_t> start_;
  std::array<Vec<3>, 2> axes_{Vec<3>::Zero(), Vec<3>::Zero()};
  Vec<3> origin_ = Vec<3>::Zero();
  bool flat_ = false;
  double tests_ = 0.0;
};

}  // namespace

void cut_polygon(std::span<const Vec<3>> places, std::span<const std::uint32_t> corners, std::span<const std::size_t> holes,
                 std::vector<Mesh<3>::Facet>& out) {
  const std::span<const std::uint32_t> outline = corners.first(holes.empty() ? corners.size() : holes[0]);
  if (outline.size() < 3) return;
  EarCutter cutter(places, outline, out);
  if (cutter.flat()) return;
  std::vector<std::span<const std::uint32_t>> rings;
  for (std::size_t k = 0; k < holes.size(); ++k)
    rings.push_back(corners.subspan(holes[k], (k + 1 < holes.size() ? holes[k + 1] : corners.size()) - holes[k]));
  cutter.join_holes(rings);
  cutter.cut();
}

}  // namespace vantage
