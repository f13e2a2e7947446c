// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/patch.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"

namespace vantage {
namespace {

template <int Dim>
Vec<Dim> anywhere(Random& random, double half) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-half, half);
  return p;
}

/// A patch of `count` corners: on a circle of a random plane, for more than two.
template <int Dim>
Patch<Dim> random_patch(Random& random, int count) {
  const Vec<Dim> center = anywhere<Dim>(random, 1.0);
  if (count == 1) return point_patch(center);
  Vec<Dim> u = anywhere<Dim>(random, 1.0).normalized(), v = anywhere<Dim>(random, 1.0);
  if (count == 2) return segment_patch(center, Vec<Dim>(center + 2.0 * u));
  v = (v - u * u.dot(v)).normalized();
  Patch<Dim> patch;
  patch.count = count;
  const double turn = random.uniform(0.0, 2.0 * kPi);
  for (int i = 0; i < count; ++i) {
    const auto [s, c] = sin_cos(turn + 2.0 * kPi * (i + 0.4 * random.uniform()) / count);
    patch.vertices[i] = center + c * u + 0.7 * s * v;
  }
  return patch;
}

/// Places of a patch, at most `spacing` apart from each other.
template <int Dim>
std::vector<Vec<Dim>> samples(const Patch<Dim>& patch, double spacing) {
  const auto& v = patch.vertices;
  std::vector<Vec<Dim>> out;
  if (patch.count == 1) return {v[0]};
  const int n = static_cast<int>(std::ceil(2.1 / spacing));
  if (patch.count == 2) {
    for (int i = 0; i <= n; ++i) out.push_back(v[0] + (v[1] - v[0]) * i / n);
    return out;
  }
  for (int t = 1; t + 1 < patch.count; ++t)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) out.push_back(v[0] + (v[t] - v[0]) * i / n + (v[t + 1] - v[0]) * j / n);
  return out;
}

template <class T>
class PatchOf : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PatchOf, Dims);

constexpr double kSpacing = 0.02;

TYPED_TEST(PatchOf, ClosestPlaceAgreesWithDenseSampling) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  for (int count = 1; count <= Patch<Dim>::kMaxVertices; ++count)
    for (int trial = 0; trial < 6; ++trial) {
      const auto patch = random_patch<Dim>(random, count);
      const auto places = samples(patch, kSpacing);
      for (int i = 0; i < 20; ++i) {
        const Vec<Dim> p = anywhere<Dim>(random, 3.0);
        double least = kInfinity;
        for (const auto& q : places) least = std::min(least, (q - p).norm());
        const double d = distance(patch, p);
        EXPECT_LE(d, least + 1e-12);
        EXPECT_GE(d, least - kSpacing);
        EXPECT_NEAR(distance(patch, closest_point(patch, p)), 0.0, 1e-9);  // The closest place is one of the patch's.
      }
      for (const auto& q : places) EXPECT_LT(distance(patch, q), 1e-9);
    }
}

TYPED_TEST(PatchOf, DistanceToSegmentAgreesWithDenseSampling) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  for (int count = 1; count <= Patch<Dim>::kMaxVertices; ++count)
    for (int trial = 0; trial < 40; ++trial) {
      const auto patch = random_patch<Dim>(random, count);
      const Vec<Dim> a = anywhere<Dim>(random, 2.0), b = trial == 0 ? a : anywhere<Dim>(random, 2.0);
      double least = kInfinity;
      const int n = static_cast<int>((b - a).norm() / kSpacing) + 1;
      for (int i = 0; i <= n; ++i) least = std::min(least, distance(patch, Vec<Dim>(a + (b - a) * i / n)));
      const double d = distance_to_segment(patch, a, b);
      EXPECT_LE(d, least + 1e-9);
      EXPECT_GE(d, least - kSpacing);
      EXPECT_NEAR(d, distance_to_segment(patch, b, a), 1e-9);
    }
}

TYPED_TEST(PatchOf, RayRangeAgreesWithMarching) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  int hits = 0, misses = 0;
  for (int count = 1; count <= Patch<Dim>::kMaxVertices; ++count)
    for (int trial = 0; trial < 200; ++trial) {
      const auto patch = random_patch<Dim>(random, count);
      const Vec<Dim> origin = anywhere<Dim>(random, 3.0);
      const Vec<Dim> target = closest_point(patch, anywhere<Dim>(random, 1.5)) + anywhere<Dim>(random, 0.3);
      const Vec<Dim> direction = (target - origin).normalized();
      const double margin = 0.1;
      const auto range = ray_range(patch, origin, direction, margin);
      // The place of least distance along the ray; the patch is convex, so that distance is too.
      double least = kInfinity;
      for (double t = 0.0; t < 9.0; t += 0.005) least = std::min(least, distance(patch, Vec<Dim>(origin + t * direction)));
      if (range) {
        ++hits;
        EXPECT_GE(*range, 0.0);
        EXPECT_LE(distance(patch, Vec<Dim>(origin + *range * direction)), margin + 1e-6);
      } else {
        ++misses;
        // A polygon is grown in its own plane only: a ray that misses it so may still pass near its edge.
        EXPECT_GT(least, patch.rank() < 2 ? margin - 0.005 : 0.0);
      }
    }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 20);
}

TYPED_TEST(PatchOf, RayThroughAPlaceOfThePatchMeetsItThere) {
  constexpr int Dim = TypeParam::value;
  Random random(4);
  for (int count = Dim; count <= Patch<Dim>::kMaxVertices; ++count)
    for (int trial = 0; trial < 50; ++trial) {
      const auto patch = random_patch<Dim>(random, count);
      Vec<Dim> inside = Vec<Dim>::Zero();
      for (const auto& corner : patch.corners()) inside += corner / count;
      const Vec<Dim> origin = inside + (0.5 + random.uniform()) * (normal(patch) + anywhere<Dim>(random, 0.5));
      const double length = (inside - origin).norm();
      const auto range = ray_range<Dim>(patch, origin, (inside - origin) / length, 0.0);
      ASSERT_TRUE(range);
      EXPECT_NEAR(*range, length, 1e-6);
      EXPECT_FALSE(ray_range<Dim>(patch, origin, (origin - inside) / length, 0.0));  // Behind the ray.
    }
}

TYPED_TEST(PatchOf, NormalIsPerpendicular) {
  constexpr int Dim = TypeParam::value;
  Random random(5);
  for (int count = 1; count <= Patch<Dim>::kMaxVertices; ++count)
    for (int trial = 0; trial < 20; ++trial) {
      const auto patch = random_patch<Dim>(random, count);
      const Vec<Dim> n = normal(patch);
      EXPECT_NEAR(n.norm(), 1.0, 1e-12);
      for (const auto& corner : patch.corners()) EXPECT_NEAR(n.dot(corner - patch.vertices[0]), 0.0, 1e-9);
    }
  EXPECT_EQ(normal(point_patch<Dim>(Vec<Dim>::Ones())), Vec<Dim>(Vec<Dim>::Unit(0)));
}

TYPED_TEST(PatchOf, Measure) {
  constexpr int Dim = TypeParam::value;
  EXPECT_EQ(measure(point_patch<Dim>(Vec<Dim>::Ones())), 0.0);
  EXPECT_EQ(measure(segment_patch<Dim>(Vec<Dim>::Zero(), 3.0 * Vec<Dim>::Unit(1))), Dim == 2 ? 3.0 : 0.0);
}

TEST(Patch3, AreaOfRegularPolygons) {
  for (int count = 3; count <= 8; ++count) {
    Patch<3> patch;
    patch.count = count;
    for (int i = 0; i < count; ++i) {
      const auto [s, c] = sin_cos(2.0 * kPi * i / count);
      patch.vertices[i] = {2.0 * c, 5.0, 2.0 * s};
    }
    EXPECT_NEAR(measure(patch), 0.5 * count * 4.0 * sin_cos(2.0 * kPi / count)[0], 1e-12);
  }
}

TEST(Patch3, SliversAreHandled) {
  // Collinear corners, and corners that coincide.
  Patch<3> line;
  line.count = 4;
  line.vertices = {Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(2, 0, 0), Vec<3>(2, 0, 0)};
  EXPECT_NEAR(distance<3>(line, {1.5, 3.0, 4.0}), 5.0, 1e-12);
  EXPECT_NEAR(distance<3>(line, {-3.0, 0.0, 4.0}), 5.0, 1e-12);
  EXPECT_NEAR(normal(line).dot(Vec<3>::Unit(0)), 0.0, 1e-12);
  EXPECT_EQ(measure(line), 0.0);
  Patch<3> dot;
  dot.count = 3;
  dot.vertices[0] = dot.vertices[1] = dot.vertices[2] = {1, 1, 1};
  EXPECT_NEAR(distance<3>(dot, {1, 1, 3}), 2.0, 1e-12);
  EXPECT_NEAR(normal(dot).norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace vantage
