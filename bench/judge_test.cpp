// SPDX-License-Identifier: Apache-2.0
#include "judge.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/world/inside_solid.h"

namespace vantage::bench {
namespace {

Vec<3> somewhere(Random& random) { return {random.uniform(), random.uniform(), random.uniform()}; }

Piece random_piece(Random& random) {
  const Vec<3> a = somewhere(random), b = a + 0.2 * somewhere(random);
  switch (random.below(4)) {
    case 0: return point(a);
    case 1: return segment(a, b);
    case 2: return triangle(a, b, a + 0.2 * somewhere(random));
    default: return box(a, b);
  }
}

/// Square of 2 x 2 m at height z.
Soup square(double z) {
  Soup soup;
  add_polygon(soup, std::array{Vec<3>(-1, -1, z), Vec<3>(1, -1, z), Vec<3>(1, 1, z), Vec<3>(-1, 1, z)});
  return soup;
}

/// A scene whose one pole is the triangle between these.
Scene<3> scene_with_pole(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
  Scene<3> scene;
  scene.mesh.vertices = {a, b, c};
  scene.mesh.facets = {{0, 1, 2}};
  scene.parts = {{"pole", 0, 1}};
  return scene;
}

TEST(Stations, AreFreeOutdoorsAndTheSameForAnyCount) {
  const auto scene = std::get<Scene<3>>(make_scene("town"));
  const RayCaster<3> caster(scene.mesh);
  const std::vector<Vec<3>> all = stations(scene, 17), few = stations(scene, 3);
  ASSERT_EQ(all.size(), 17U);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), all.begin()));
  for (const Vec<3>& p : all) {
    EXPECT_FALSE(inside_solid<3>(caster, p));
    EXPECT_GE(caster.distance(p), 1.0);
    EXPECT_EQ(caster.cast(p, Vec<3>::UnitZ()).range, kInfinity) << "a roof";
    EXPECT_TRUE(scene.domain.contains(p));
  }
}

TEST(Nearest, EqualsTryingAllPieces) {
  Random random(1);
  Soup soup;
  for (int i = 0; i < 500; ++i) soup.push_back(random_piece(random));
  const Nearest nearest(soup);
  for (int i = 0; i < 500; ++i) {
    const Vec<3> p = 2.0 * somewhere(random) - Vec<3>::Constant(0.5);
    double least = kInfinity;
    for (const Piece& piece : soup) least = std::min(least, piece.distance(p));
    EXPECT_EQ(nearest.distance(p), least);
    EXPECT_EQ(nearest.distance(p, 0.5 * least), 0.5 * least);
  }
}

TEST(Piece, TriangleIsAsNearAsItsNearestOfManyPlaces) {
  Random random(2);
  const Vec<3> a = somewhere(random), b = somewhere(random), c = somewhere(random);
  for (int k = 0; k < 50; ++k) {
    const Vec<3> p = 3.0 * somewhere(random) - Vec<3>::Ones();
    double least = kInfinity;
    for (int i = 0; i <= 200; ++i)
      for (int j = 0; i + j <= 200; ++j) least = std::min(least, (a + (b - a) * (i / 200.0) + (c - a) * (j / 200.0) - p).norm());
    EXPECT_LE(triangle(a, b, c).distance(p), least + 1e-12);
    EXPECT_GE(triangle(a, b, c).distance(p), least - 0.01);
  }
}

TEST(Judge, OnePointUnderASquare) {
  const std::vector<Vec<3>> data{Vec<3>(0, 0, 0)};
  const Judge judge(scene_with_pole({9, 9, 9}, {9, 9, 8}, {9, 8, 9}), data);
  const Score score = judge.score(square(0.5));
  EXPECT_DOUBLE_EQ(score.data_to_surface.maximum, 0.5);
  EXPECT_NEAR(score.surface_to_data.maximum, 1.5, 2e-3);  // A corner: sqrt(1 + 1 + 0.25).
  EXPECT_LE(score.surface_to_data.p99, score.surface_to_data.maximum);
  EXPECT_EQ(judge.pole_places(), 0U) << "nothing of the pole was observed";
}

TEST(Judge, CornersOfASolidBoxAreItsFarthestPlaces) {
  const std::vector<Vec<3>> data{Vec<3>(0.1, 0.1, 0.1)};
  const Judge judge({}, data);
  const Score score = judge.score({box(Vec<3>::Zero(), Vec<3>::Ones())});
  EXPECT_EQ(score.data_to_surface.maximum, 0.0);
  EXPECT_NEAR(score.surface_to_data.maximum, 0.9 * std::sqrt(3.0), 2e-3);
}

TEST(Judge, RecallIsTheShareWithinATenth) {
  // A sliver of a pole along x, all of it measured; the surface covers its first half, and a tenth of a metre more counts.
  const Vec<3> a(0, 0, 0), b(10, 0, 0), c(10, 0, 0.02);
  std::vector<Vec<3>> data;
  for (int i = 0; i <= 1000; ++i) data.emplace_back(0.01 * i, 0, 0);
  const Judge judge(scene_with_pole(a, b, c), data);
  EXPECT_NEAR(static_cast<double>(judge.pole_places()), 0.1 * 2000.0, 2.0);
  EXPECT_NEAR(judge.score({segment(a, 0.5 * b)}).poles, 0.26, 0.1);
  EXPECT_EQ(judge.score({segment(a, b)}).poles, 1.0);
  EXPECT_EQ(judge.score({point(Vec<3>(50, 0, 0))}).poles, 0.0);
}

TEST(Judge, AnEmptySurfaceReachesNothing) {
  const std::vector<Vec<3>> data{Vec<3>(0, 0, 0)};
  EXPECT_EQ(Judge({}, data).score({}).data_to_surface.maximum, kInfinity);
}

}  // namespace
}  // namespace vantage::bench
