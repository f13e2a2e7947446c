// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/ears.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>
#include <string>

#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"

namespace vantage {
namespace {

struct Ring {
  std::vector<Vec<2>> corners;
};

double area(const Ring& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.corners.size(); ++i) {
    const Vec<2>&a = ring.corners[i], &b = ring.corners[(i + 1) % ring.corners.size()];
    sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return sum;
}

/// A star around `middle` between two radii, ragged.
Ring star(const Vec<2>& middle, double inner, double outer, int corners, Random& random) {
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const auto [s, c] = sin_cos(2.0 * kPi * (i + 0.8 * random.uniform()) / corners);
    ring.corners.push_back(middle + (inner + (outer - inner) * random.uniform()) * Vec<2>(c, s));
  }
  return ring;
}

/// Whether p lies in the ring (crossings of a ray).
bool inside(const Ring& ring, const Vec<2>& p) {
  bool odd = false;
  for (std::size_t i = 0, k = ring.corners.size() - 1; i < ring.corners.size(); k = i++) {
    const Vec<2>&a = ring.corners[i], &b = ring.corners[k];
    if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1])) odd = !odd;
  }
  return odd;
}

/// A pose of the plane in space, far from the origin, as maps have it.
struct Sheet {
  Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7, Vec<3>(1, 2, 3).normalized())).toRotationMatrix();
  Vec<3> shift{84616.0, 447423.0, -3.0};
  [[nodiscard]] Vec<3> lift(const Vec<2>& p) const { return turn * Vec<3>(p[0], p[1], 0.0) + shift; }
  [[nodiscard]] Vec<2> flat(const Vec<3>& p) const { return (turn.transpose() * (p - shift)).head<2>(); }
};

/// Cuts and checks: as much area as the outline has without the holes, every triangle turning like the outline, its middle in the outline and in no
/// hole, and at most two triangles fewer than corners and bridges have.
void expect_cut(const std::vector<Ring>& rings, const std::string& what) {
  const Sheet sheet;
  std::vector<Vec<3>> places;
  std::vector<std::uint32_t> corners;
  std::vector<std::size_t> holes;
  for (const Ring& ring : rings) {
    if (!corners.empty()) holes.push_back(corners.size());
    for (const Vec<2>& p : ring.corners) {
      corners.push_back(static_cast<std::uint32_t>(places.size()));
      places.push_back(sheet.lift(p));
    }
  }
  std::vector<Mesh<3>::Facet> facets;
  cut_polygon(places, corners, holes, facets);
  double wanted = std::abs(area(rings[0])), found = 0.0;
  for (std::size_t k = 1; k < rings.size(); ++k) wanted -= std::abs(area(rings[k]));
  const double sign = area(rings[0]) > 0.0 ? 1.0 : -1.0;
  for (const auto& f : facets) {
    const Ring triangle{{sheet.flat(places[f[0]]), sheet.flat(places[f[1]]), sheet.flat(places[f[2]])}};
    const double size = area(triangle);
    found += std::abs(size);
    EXPECT_GE(sign * size, -1e-9) << what;
    if (std::abs(size) < 1e-9) continue;
    const Vec<2> middle = (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0;
    EXPECT_TRUE(inside(rings[0], middle)) << what;
    for (std::size_t k = 1; k < rings.size(); ++k) EXPECT_FALSE(inside(rings[k], middle)) << what;
  }
  EXPECT_NEAR(found, wanted, 1e-7 * wanted) << what;
  EXPECT_LE(facets.size(), corners.size() + 2 * holes.size() - 2) << what;
}

TEST(CutPolygon, StarsWithHolesKeepTheirArea) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    std::vector<Ring> rings{star({0, 0}, 6.0, 9.0, 3 + static_cast<int>(random.below(60)) + 20, random)};
    const auto holes = random.below(7);
    for (std::uint64_t k = 0; k < holes; ++k) {
      const auto [s, c] = sin_cos(2.0 * kPi * static_cast<double>(k) / static_cast<double>(holes));
      rings.push_back(star(Vec<2>(3.4 * c, 3.4 * s), 0.4, 1.4, 4 + static_cast<int>(random.below(12)), random));
    }
    rings.push_back(star({0, 0}, 0.5, 1.5, 9, random));
    for (Ring& ring : rings)
      if (random.below(2) == 0) std::reverse(ring.corners.begin(), ring.corners.end());
    expect_cut(rings, "seed " + std::to_string(seed));
  }
}

TEST(CutPolygon, WindowsOfAFacade) {
  std::vector<Ring> rings{{{{0, 0}, {40, 0}, {40, 20}, {0, 20}}}};
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 4; ++k) {
      const double x = 2.0 + 4.75 * i, y = 2.0 + 4.5 * k;
      rings.push_back({{{x, y}, {x, y + 2}, {x + 1, y + 2}, {x + 1, y}}});
    }
  expect_cut(rings, "facade");
}

TEST(CutPolygon, ManyCornersAreCutWithinTheOutline) {
  Random random(5);
  expect_cut({star({0, 0}, 3.0, 9.0, 3000, random)}, "3000 corners");
  Ring comb;  // Teeth that a fan would cross.
  for (int i = 0; i < 400; ++i) comb.corners.insert(comb.corners.end(), {{i, 0.0}, {i + 0.5, 10.0}});
  comb.corners.insert(comb.corners.end(), {{400.0, 0.0}, {400.0, -1.0}, {0.0, -1.0}});
  expect_cut({comb}, "comb");
}

TEST(CutPolygon, WhatIsNoPolygonGivesNothing) {
  const std::vector<Vec<3>> places{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {5, 5, 0}, {6, 5, 0}, {6, 6, 0}};
  std::vector<Mesh<3>::Facet> out;
  const auto cut = [&](std::vector<std::uint32_t> corners, std::vector<std::size_t> holes) {
    out.clear();
    cut_polygon(places, corners, holes, out);
    return out.size();
  };
  EXPECT_EQ(cut({}, {}), 0U);
  EXPECT_EQ(cut({0, 1}, {}), 0U);
  EXPECT_EQ(cut({0, 1, 2}, {}), 0U);            // On a line.
  EXPECT_EQ(cut({0, 0, 1, 1, 3, 3}, {}), 1U);   // Corners given twice.
  EXPECT_EQ(cut({0, 2, 3, 4, 5, 6}, {3}), 1U);  // A hole outside.
  EXPECT_EQ(cut({0, 2, 3, 1}, {3}), 1U);        // A hole of one corner.
  EXPECT_EQ(cut({0, 1, 2, 3}, {}), 2U);         // A corner on a side.
}

}  // namespace
}  // namespace vantage
