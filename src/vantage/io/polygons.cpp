// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/polygons.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <span>
#include <unordered_map>

#include <Eigen/Geometry>

#include "vantage/base/error.h"
#include "vantage/io/ears.h"

namespace vantage {
namespace {

using Facet = Mesh<3>::Facet;
constexpr std::size_t kMostEars = 512;  ///< Larger polygons go to `cut_polygon`, which is made for them.

void check(const Polygons& p, const std::string& name) {
  for (std::size_t i = 0; i < p.vertices.size(); ++i) require(p.vertices[i].allFinite(), fmt::format("vertex {} is not finite", i), name);
  std::size_t polygon = 0;
  for (std::size_t i = 0; i < p.corners.size(); ++i) {
    while (i >= p.ends[polygon]) ++polygon;
    require(p.corners[i] >= 0 && p.corners[i] < static_cast<std::int64_t>(p.vertices.size()),
            fmt::format("face {} names vertex {}: must be 0 .. {}", polygon, p.corners[i], static_cast<std::int64_t>(p.vertices.size()) - 1), name);
  }
}

struct SameBits {
  std::size_t operator()(const std::array<double, 3>& v) const {
    std::uint64_t hash = 0;
    for (const double x : v) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// For each vertex the number of its place, in the order of first use by a corner; vertices without use have none. Fills `places`.
std::vector<std::uint32_t> join_vertices(const Polygons& p, std::vector<Vec<3>>& places) {
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> place_of(p.vertices.size(), kNone);
  std::unordered_map<std::array<double, 3>, std::uint32_t, SameBits> known;
  for (const std::int64_t corner : p.corners) {
    std::uint32_t& place = place_of[static_cast<std::size_t>(corner)];
    if (place != kNone) continue;
    const Vec<3> v = p.vertices[static_cast<std::size_t>(corner)].array() + 0.0;  // -0 becomes 0.
    place = known.try_emplace({v[0], v[1], v[2]}, static_cast<std::uint32_t>(places.size())).first->second;
    if (place == places.size()) places.push_back(v);
  }
  return place_of;
}

/// Cuts one polygon; `corners` are places.
class Cutter {
 public:
  Cutter(const std::vector<Vec<3>>& places, std::vector<Facet>& out) : places_(places), out_(out) {}

  void cut(std::span<const std::uint32_t> corners, std::span<const std::size_t> holes) {
    if (!holes.empty() || corners.size() > kMostEars) return cut_polygon(places_, corners, holes, out_);
    if (corners.size() > 3) return cut_ears(corners);
    for (std::size_t i = 2; i < corners.size(); ++i) add(corners[0], corners[i - 1], corners[i]);
  }

 private:
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { out_.push_back({a, b, c}); }
  [[nodiscard]] double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (places_[b] - places_[a]).cross(places_[c] - places_[a]).dot(normal_);
  }
  [[nodiscard]] bool is_ear(const std::vector<std::uint32_t>& ring, std::size_t i) const {
    const std::size_t n = ring.size();
    const std::uint32_t a = ring[(i + n - 1) % n], b = ring[i], c = ring[(i + 1) % n];
    if (!(turn(a, b, c) > 0.0)) return false;
    for (const std::uint32_t p : ring)
      if (p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    return true;
  }
  /// Ear after ear (Meisters 1975), seen along the polygon's mean normal; what has no ear left, being twisted, goes on as a fan.
  void cut_ears(std::span<const std::uint32_t> corners) {
    std::vector<std::uint32_t> ring(corners.begin(), corners.end());
    normal_.setZero();
    for (std::size_t i = 0; i < ring.size(); ++i)
      normal_ += (places_[ring[i]] - places_[ring[0]]).cross(places_[ring[(i + 1) % ring.size()]] - places_[ring[0]]);
    while (ring.size() > 3) {
      std::size_t ear = 0;
      while (ear < ring.size() && !is_ear(ring, (ear + 1) % ring.size())) ++ear;  // A convex one becomes a fan around its first corner.
      if (ear == ring.size()) break;
      const std::size_t n = ring.size(), i = (ear + 1) % n;
      add(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    }
    for (std::size_t i = 2; i < ring.size(); ++i) add(ring[0], ring[i - 1], ring[i]);
  }

  const std::vector<Vec<3>>& places_;
  std::vector<Facet>& out_;
  Vec<3> normal_ = Vec<3>::Zero();
};

}  // namespace

Mesh<3> triangles(const Polygons& p, const std::string& name) {
  check(p, name);
  require(p.vertices.size() < 0xffffffff && p.corners.size() < 0xffffffff, "more than 4 billion vertices", name);
  Mesh<3> mesh;
  const std::vector<std::uint32_t> place_of = join_vertices(p, mesh.vertices);
  Cutter cutter(mesh.vertices, mesh.facets);
  std::vector<std::uint32_t> ring;
  std::vector<std::size_t> holes;
  std::size_t begin = 0, hole = 0;
  for (const std::size_t end : p.ends) {
    ring.clear();
    holes.clear();
    for (std::size_t i = begin; i < end; ++i) ring.push_back(place_of[static_cast<std::size_t>(p.corners[i])]);
    while (hole < p.holes.size() && p.holes[hole] < end) holes.push_back(p.holes[hole++] - begin);
    cutter.cut(ring, holes);
    begin = end;
  }
  require(!mesh.facets.empty(), fmt::format("holds no triangles ({} vertices, {} faces)", p.vertices.size(), p.ends.size()), name);
  return mesh;
}

}  // namespace vantage
