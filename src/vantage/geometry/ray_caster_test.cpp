// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/ray_caster.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/geometry/patch.h"

namespace vantage {
namespace {

template <int Dim>
Vec<Dim> random_point(Random& random, double half) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-half, half);
  return p;
}

template <int Dim>
Vec<Dim> random_direction(Random& random) {
  for (;;)
    if (const Vec<Dim> d = random_point<Dim>(random, 1.0); d.norm() > 0.1 && d.norm() < 1.0) return d.normalized();
}

/// Facets of size about 1 in a cube of half width 5, moved by `shift`.
template <int Dim>
Mesh<Dim> soup(int count, std::uint64_t seed, double shift = 0.0) {
  Random random(seed);
  Mesh<Dim> mesh;
  for (int i = 0; i < count; ++i) {
    const Vec<Dim> center = random_point<Dim>(random, 5.0).array() + shift;
    typename Mesh<Dim>::Facet facet;
    for (std::uint32_t& v : facet) {
      v = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(center + random_point<Dim>(random, 1.0));
    }
    mesh.facets.push_back(facet);
  }
  return mesh;
}

/// Another way to the same: solve corner combination = origin + t direction. `edge` is the least weight, near 0 at the facet's rim.
template <int Dim>
struct OracleHit {
  double range = kInfinity;
  std::uint32_t facet = 0xffffffff;
  bool doubtful = false;  ///< Some facet nearer than the hit was missed or met by a hair.
};

template <int Dim>
OracleHit<Dim> brute_force(const Mesh<Dim>& mesh, const Vec<Dim>& origin, const Vec<Dim>& direction) {
  OracleHit<Dim> best;
  for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
    Eigen::Matrix<double, Dim, Dim> matrix;
    const auto& facet = mesh.facets[f];
    for (int i = 1; i < Dim; ++i) matrix.col(i - 1) = mesh.vertices[facet[i]] - mesh.vertices[facet[0]];
    matrix.col(Dim - 1) = -direction;
    const Vec<Dim> solution = matrix.fullPivLu().solve(Vec<Dim>(origin - mesh.vertices[facet[0]]));
    double edge = solution.template head<Dim - 1>().minCoeff();
    edge = std::min(edge, 1.0 - solution.template head<Dim - 1>().sum());
    const double t = solution[Dim - 1];
    if (t < -1e-9 || edge < -1e-9 || t > best.range) continue;
    if (t < 1e-9 || edge < 1e-9)
      best.doubtful = true;
    else
      best.range = t, best.facet = f;
  }
  return best;
}

template <class T>
class RayCasterTest : public testing::Test {};
using Dims = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RayCasterTest, Dims);

TYPED_TEST(RayCasterTest, MeetsTheFacetThatBruteForceMeets) {
  constexpr int Dim = TypeParam::value;
  for (const double shift : {0.0, 1e6}) {
    const Mesh<Dim> mesh = soup<Dim>(Dim * Dim * Dim * 7, 7, shift);
    const RayCaster<Dim> caster(mesh);
    Random random(3);
    int hits = 0, misses = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec<Dim> origin = random_point<Dim>(random, i % 2 == 0 ? 5.0 : 40.0).array() + shift;
      const Vec<Dim> target = random_point<Dim>(random, 5.0).array() + shift;
      const Vec<Dim> direction = (target - origin).normalized();
      const auto truth = brute_force<Dim>(mesh, origin, direction);
      if (truth.doubtful) continue;
      const auto hit = caster.cast(origin, direction);
      ASSERT_EQ(hit.facet, truth.facet) << i;
      if (truth.facet == 0xffffffff) {
        EXPECT_EQ(hit.range, kInfinity);
        ++misses;
        continue;
      }
      ++hits;
      ASSERT_NEAR(hit.range, truth.range, shift == 0.0 ? 1e-10 : 1e-7);
      EXPECT_EQ(caster.cast(origin, direction, hit.range).facet, hit.facet);
      EXPECT_NE(caster.cast(origin, direction, hit.range * (1.0 - 1e-12) - 1e-12).facet, hit.facet);
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(misses, 20);
  }
}

TYPED_TEST(RayCasterTest, EqualRangesGoToTheFirstFacet) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh = soup<Dim>(60, 11);
  const std::size_t count = mesh.facets.size();
  for (std::size_t i = 0; i < count; ++i) mesh.facets.push_back(mesh.facets[i]);
  const RayCaster<Dim> caster(mesh);
  Random random(5);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto hit = caster.cast(random_point<Dim>(random, 6.0), random_direction<Dim>(random));
    if (hit.facet == 0xffffffff) continue;
    ++hits;
    ASSERT_LT(hit.facet, count);
  }
  EXPECT_GT(hits, 100);
}

TYPED_TEST(RayCasterTest, DistanceIsThatOfTheNearestFacet) {
  constexpr int Dim = TypeParam::value;
  for (const double shift : {0.0, 1e6}) {
    const Mesh<Dim> mesh = soup<Dim>(150, 9, shift);
    const RayCaster<Dim> caster(mesh);
    Random random(4);
    for (int i = 0; i < 600; ++i) {
      const Vec<Dim> p = random_point<Dim>(random, i % 3 == 0 ? 500.0 : 6.0).array() + shift;
      double truth = kInfinity;
      for (const auto& facet : mesh.facets) {
        Patch<Dim> patch;
        patch.count = Dim;
        for (int k = 0; k < Dim; ++k) patch.vertices[k] = mesh.vertices[facet[k]];
        truth = std::min(truth, distance(patch, p));
      }
      ASSERT_EQ(caster.distance(p), truth);
      ASSERT_EQ(caster.distance(p, 0.5 * truth), 0.5 * truth);
      ASSERT_EQ(caster.distance(p, 2.0 * truth), truth);
    }
  }
}

/// Closed surface of the unit cube's image under a random linear map: one facet list per dimension, by subdivision of each side.
Mesh<2> closed_box(std::integral_constant<int, 2>) {
  Mesh<2> mesh;
  mesh.vertices = {{-1.3, -0.7}, {1.1, -0.9}, {1.7, 0.8}, {-0.6, 1.9}};
  mesh.facets = {{0, 1}, {2, 1}, {2, 3}, {3, 0}};
  return mesh;
}

Mesh<3> closed_box(std::integral_constant<int, 3>) {
  Mesh<3> mesh;
  Eigen::Matrix3d skew;
  skew << 1.1, 0.2, -0.1, 0.05, 0.9, 0.3, -0.2, 0.1, 1.3;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back(skew * Vec<3>(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  mesh.facets = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TYPED_TEST(RayCasterTest, NothingLeaksThroughSharedEdgesAndCorners) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = closed_box(TypeParam{});
  const RayCaster<Dim> caster(mesh);
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    const Vec<Dim> origin = random_point<Dim>(random, 0.3);
    const auto& facet = mesh.facets[random.below(mesh.facets.size())];
    const double s = i % 3 == 0 ? 0.0 : random.uniform();  // A corner, or a place on an edge.
    const Vec<Dim> target = mesh.vertices[facet[0]] + s * (mesh.vertices[facet[1]] - mesh.vertices[facet[0]]);
    const auto hit = caster.cast(origin, (target - origin).normalized());
    ASSERT_NE(hit.facet, 0xffffffff) << i;
    ASSERT_NEAR(hit.range, (target - origin).norm(), 1e-9);
  }
}

TYPED_TEST(RayCasterTest, AnswersTheSameOnEveryThread) {
  constexpr int Dim = TypeParam::value;
  const RayCaster<Dim> caster(soup<Dim>(300, 2));
  const auto shoot = [&](int threads) {
    const ThreadLimit limit(threads);
    std::vector<double> ranges(5000);
    parallel_for(ranges.size(), 64, [&](std::size_t i) {
      Random random(1, i);
      const Vec<Dim> origin = random_point<Dim>(random, 6.0);
      ranges[i] = caster.cast(origin, random_direction<Dim>(random)).range + caster.distance(origin);
    });
    return ranges;
  };
  EXPECT_EQ(shoot(1), shoot(7));
}

TYPED_TEST(RayCasterTest, EmptyAndDegenerateWorlds) {
  constexpr int Dim = TypeParam::value;
  const RayCaster<Dim> nothing{Mesh<Dim>{}};
  EXPECT_EQ(nothing.cast(Vec<Dim>::Zero(), Vec<Dim>::Unit(0)).range, kInfinity);
  EXPECT_EQ(nothing.distance(Vec<Dim>::Zero(), 3.0), 3.0);
  Mesh<Dim> point;  // All corners of the one facet coincide: seen by distance, met by no ray.
  point.vertices = {Vec<Dim>::Ones()};
  point.facets = {{}};
  const RayCaster<Dim> caster(point);
  EXPECT_EQ(caster.cast(Vec<Dim>::Zero(), Vec<Dim>::Ones().normalized()).range, kInfinity);
  EXPECT_DOUBLE_EQ(caster.distance(Vec<Dim>::Zero()), std::sqrt(static_cast<double>(Dim)));
}

TYPED_TEST(RayCasterTest, RefusesBrokenMeshes) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh = soup<Dim>(2, 1);
  mesh.facets[1][0] = 99;
  EXPECT_THROW(RayCaster<Dim>{mesh}, Error);
  mesh = soup<Dim>(2, 1);
  mesh.vertices[1][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RayCaster<Dim>{mesh}, Error);
}

TYPED_TEST(RayCasterTest, AxisAlignedRaysAndWalls) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh;  // One wall across the first axis at 2.
  for (int i = 0; i < Dim; ++i) {
    Vec<Dim> v = Vec<Dim>::Constant(-1.0);
    if (i > 0) v[i] = 5.0;
    v[0] = 2.0;
    mesh.vertices.push_back(v);
    mesh.facets.resize(1);
    mesh.facets[0][i] = static_cast<std::uint32_t>(i);
  }
  const RayCaster<Dim> caster(mesh);
  EXPECT_EQ(caster.cast(Vec<Dim>::Zero(), Vec<Dim>::Unit(0)).range, 2.0);
  EXPECT_EQ(caster.cast(Vec<Dim>::Zero(), -Vec<Dim>::Unit(0)).range, kInfinity);
  EXPECT_EQ(caster.cast(Vec<Dim>::Zero(), Vec<Dim>::Unit(1)).range, kInfinity);
  EXPECT_EQ(caster.cast(2.0 * Vec<Dim>::Unit(0), Vec<Dim>::Unit(0)).range, 0.0);
  EXPECT_EQ(caster.cast(1e9 * -Vec<Dim>::Unit(0), Vec<Dim>::Unit(0)).range, 1e9 + 2.0);
}

}  // namespace
}  // namespace vantage
