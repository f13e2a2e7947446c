// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/zone.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "vantage/base/error.h"

namespace vantage {
namespace {

using Ring = std::vector<Vec<2>>;

/// > 0 where c lies to the left of the line from a to b.
double turn(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) { return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x(); }

struct Edge {
  Vec<2> a, b;
  std::size_t ring = 0, number = 0;

  [[nodiscard]] Box<2> bounds() const { return {a.cwiseMin(b), a.cwiseMax(b)}; }
  [[nodiscard]] bool holds(const Vec<2>& p) const { return turn(a, b, p) == 0.0 && bounds().contains(p); }
  [[nodiscard]] bool meets(const Edge& other) const {
    const double c = turn(a, b, other.a), d = turn(a, b, other.b), e = turn(other.a, other.b, a), f = turn(other.a, other.b, b);
    if (((c > 0.0 && d < 0.0) || (c < 0.0 && d > 0.0)) && ((e > 0.0 && f < 0.0) || (e < 0.0 && f > 0.0))) return true;
    return holds(other.a) || holds(other.b) || other.holds(a) || other.holds(b);
  }
};

std::vector<Edge> edges_of(const Zone& zone) {
  std::vector<Edge> edges;
  for (std::size_t r = 0; r < zone.rings.size(); ++r)
    for (std::size_t k = 0; k < zone.rings[r].size(); ++k) edges.push_back({zone.rings[r][k], zone.rings[r][(k + 1) % zone.rings[r].size()], r, k});
  return edges;
}

/// Even-odd over all rings; borders count as inside.
bool covers(const Zone& zone, const Vec<2>& p) {
  bool inside = false;
  for (const Ring& ring : zone.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Edge edge{ring[k], ring[(k + 1) % ring.size()]};
      if (edge.holds(p)) return true;
      if ((edge.a.y() > p.y()) == (edge.b.y() > p.y())) continue;
      const bool left = (turn(edge.a, edge.b, p) > 0.0) == (edge.b.y() > edge.a.y());
      inside = inside != left;
    }
  return inside;
}

/// Whether a part of the edge lies in the box.
bool enters(const Edge& edge, const Box<2>& box) {
  double from = 0.0, to = 1.0;
  const Vec<2> d = edge.b - edge.a;
  for (int a = 0; a < 2; ++a) {
    if (d[a] == 0.0) {
      if (edge.a[a] < box.low[a] || edge.a[a] > box.high[a]) return false;
      continue;
    }
    const double first = (box.low[a] - edge.a[a]) / d[a], last = (box.high[a] - edge.a[a]) / d[a];
    from = std::max(from, std::min(first, last));
    to = std::min(to, std::max(first, last));
  }
  return from <= to;
}

Vec<3> in_space(const Vec<2>& p) { return {p[0], p[1], 0.0}; }
Vec<3> in_space(const Vec<3>& p) { return p; }

std::pair<double, double> heights(const Box<2>&) { return {-kInfinity, kInfinity}; }
std::pair<double, double> heights(const Box<3>& box) { return {box.low.z(), box.high.z()}; }

/// Neighbours of a ring share a corner, and only that.
bool may_meet(const Edge& e, const Edge& f, std::size_t corners) {
  if (e.ring != f.ring) return false;
  const bool before = (e.number + 1) % corners == f.number, behind = (f.number + 1) % corners == e.number;
  if (!before && !behind) return false;
  const Edge &first = before ? e : f, &second = before ? f : e;
  return turn(first.a, first.b, second.b) != 0.0 || (first.b - first.a).dot(second.b - second.a) > 0.0;
}

void check_crossings(const Zone& zone, const std::string& where) {
  std::vector<Edge> edges = edges_of(zone);
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.bounds().low.x() < b.bounds().low.x(); });
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && edges[j].bounds().low.x() <= edges[i].bounds().high.x(); ++j) {
      const Edge &e = edges[i], &f = edges[j];
      if (!e.meets(f) || may_meet(e, f, zone.rings[e.ring].size())) continue;
      const Vec<2>& at = e.holds(f.b) ? f.b : f.a;
      require(false,
              fmt::format("the polygon crosses or touches itself near {:.10g},{:.10g}: its sides may meet at the corners only", at.x(), at.y()),
              where);
    }
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
bool Zone::contains(const Vec<Dim>& p) const {
  const Vec<3> q = in_space(p);
  return q.z() >= low && q.z() <= high && covers(*this, q.template head<2>());
}

template <int Dim>
  requires SpatialDim<Dim>
bool Zone::meets(const Box<Dim>& box) const {
  const Vec<3> from = in_space(box.low), to = in_space(box.high);
  if (from.z() > high || to.z() < low) return false;
  const Box<2> flat{from.head<2>(), to.head<2>()};
  const std::vector<Edge> edges = edges_of(*this);
  return std::any_of(edges.begin(), edges.end(), [&](const Edge& edge) { return enters(edge, flat); }) || covers(*this, flat.low);
}

Box<2> Zone::bounds() const {
  Box<2> box;
  for (const Vec<2>& p : rings.empty() ? Ring() : rings.front()) box.extend(p);
  return box;
}

template <int Dim>
  requires SpatialDim<Dim>
Zone box_zone(const Box<Dim>& box) {
  const Vec<2> low = box.low.template head<2>(), high = box.high.template head<2>();
  const auto [bottom, top] = heights(box);
  return {{{low, {high.x(), low.y()}, high, {low.x(), high.y()}}}, bottom, top};
}

void tidy_zone(Zone& zone, const std::string& where) {
  require(zone.low <= zone.high, fmt::format("heights {:g} .. {:g}: the lower comes first", zone.low, zone.high), where);
  require(!zone.rings.empty(), "the polygon has no corners", where);
  for (Ring& ring : zone.rings) {
    for (const Vec<2>& p : ring) require(p.allFinite(), fmt::format("{},{}: must be finite numbers", p.x(), p.y()), where);
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
    require(ring.size() >= 3, fmt::format("{} corner{}: a polygon has at least 3", ring.size(), ring.size() == 1 ? "" : "s"), where);
  }
  check_crossings(zone, where);
}

#define VANTAGE_INSTANTIATE(D)                          \
  template bool Zone::contains<D>(const Vec<D>&) const; \
  template bool Zone::meets<D>(const Box<D>&) const;    \
  template Zone box_zone<D>(const Box<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
