// SPDX-License-Identifier: Apache-2.0
// Degenerate clouds, each reconstructed in both modes and checked by the exhaustive verifier.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "vantage/audit/test_clouds.h"
#include "vantage/base/error.h"

namespace vantage {
namespace {

using test::anywhere;
using test::Cloud;

template <int Dim>
Box<Dim> cube(double half = 8.0) {
  return {Vec<Dim>::Constant(-half), Vec<Dim>::Constant(half)};
}

/// The cloud's surface over the domain. Expects that its certificate holds, that nothing is farther than eta with our own rules, and that every
/// finite point inside counts. `domain` is a cube.
template <int Dim>
SurfaceStatistics verified(const Cloud<Dim>& cloud, const Box<Dim>& domain, const SurfaceOptions& options) {
  HausdorffTree<Dim> tree(domain, options);
  tree.insert(cloud);
  const std::vector<Patch<Dim>> patches = tree.patches();
  const SurfaceStatistics s = tree.statistics();
  Cloud<Dim> held;  // What is outside is not the tree's.
  std::copy_if(cloud.begin(), cloud.end(), std::back_inserter(held), [&](const Vec<Dim>& p) { return !p.allFinite() || domain.contains(p); });
  EXPECT_EQ(s.outside, static_cast<std::int64_t>(cloud.size() - held.size()));
  const CertificateReport report = check_certificate<Dim>(held, patches, test::certificate_of(tree));
  EXPECT_TRUE(report.holds()) << report.faults.front();
  EXPECT_EQ(s.points + s.outside + s.not_finite, static_cast<std::int64_t>(cloud.size()));
  EXPECT_EQ(s.not_finite, report.not_finite);
  EXPECT_EQ(static_cast<std::int64_t>(patches.size()), s.fits + s.segments + s.loose_points);
  EXPECT_EQ(s.leaves, ((1 << Dim) - 1) * (s.nodes - s.leaves) + 1);
  EXPECT_LE(s.depth, options.max_depth);
  if (!options.paper) {
    EXPECT_LE(s.certified(), options.eta);
    EXPECT_LE(report.data_to_surface.max, options.eta);
    EXPECT_LE(report.surface_to_data_low, options.eta);
  }
  return s;
}

/// In the domain of `vantage reconstruct` and in a cube around the origin, by our rules and by the paper's; returns ours in the cube.
template <int Dim>
SurfaceStatistics verified_both(const Cloud<Dim>& cloud, double eta = 0.1) {
  Box<Dim> box;
  for (const Vec<Dim>& p : cloud)
    if (p.allFinite()) box.extend(p);
  if (!box.empty()) {
    box = Box<Dim>{box.center(), box.center()}.grown(0.501 * box.size().maxCoeff() + 1e-6);
    verified<Dim>(cloud, box, {.eta = eta});
    verified<Dim>(cloud, box, {.eta = eta, .paper = true});
  }
  verified<Dim>(cloud, cube<Dim>(), {.eta = eta, .paper = true});
  return verified<Dim>(cloud, cube<Dim>(), {.eta = eta});
}

template <class T>
class Degenerate : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Degenerate, Dims);

TYPED_TEST(Degenerate, None) {
  constexpr int Dim = TypeParam::value;
  const SurfaceStatistics s = verified_both<Dim>({});
  EXPECT_EQ(s.nodes, 1);
  EXPECT_EQ(s.points, 0);
  EXPECT_EQ(s.certified(), 0.0);
}

TYPED_TEST(Degenerate, AllEqual) {
  constexpr int Dim = TypeParam::value;
  for (const int count : {1, 2, Dim + 1, Dim + 2, 200, 5000})
    for (const Vec<Dim>& p : {Vec<Dim>(Vec<Dim>::Zero()), Vec<Dim>(Vec<Dim>::Constant(-8.0)), Vec<Dim>(Vec<Dim>::Constant(1.0 / 3.0))}) {
      SCOPED_TRACE(count);
      const SurfaceStatistics s = verified_both<Dim>(Cloud<Dim>(static_cast<std::size_t>(count), p));
      EXPECT_EQ(s.points, count);
      EXPECT_EQ(s.nodes, 1);
      EXPECT_EQ(s.fits + s.segments + s.loose_points, 1);
    }
}

TYPED_TEST(Degenerate, TwoPlacesManyTimes) {
  constexpr int Dim = TypeParam::value;
  for (const double apart : {1e-9, 1e-4, 0.05, 0.15, 0.5, 15.0}) {
    SCOPED_TRACE(apart);
    Cloud<Dim> cloud;
    for (int i = 0; i < 3000; ++i) cloud.push_back(Vec<Dim>::Constant(-7.5) + (i % 2) * apart * Vec<Dim>::Unit(Dim - 1));
    const SurfaceStatistics s = verified_both<Dim>(cloud);
    EXPECT_LE(s.fits + s.segments + s.loose_points, 2);
  }
}

TYPED_TEST(Degenerate, FewerThanAFitNeeds) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    Cloud<Dim> cloud;
    for (std::uint64_t i = 1 + random.below(Dim + 1); i > 0; --i) cloud.push_back(anywhere<Dim>(random, 7.9));
    const SurfaceStatistics s = verified_both<Dim>(cloud, 0.05);
    RC_ASSERT(s.loose_points <= static_cast<std::int64_t>(cloud.size()));
    RC_ASSERT(s.nodes == 1);
    RC_ASSERT(!::testing::Test::HasFailure());
  }));
}

TYPED_TEST(Degenerate, Collinear) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  std::vector<Vec<Dim>> directions;
  for (int a = 0; a < Dim; ++a) directions.push_back(Vec<Dim>::Unit(a));
  directions.push_back(Vec<Dim>::Ones());
  for (int i = 0; i < 3; ++i) directions.push_back(anywhere<Dim>(random, 1.0).normalized());
  for (const Vec<Dim>& u : directions)
    for (const Vec<Dim>& at : {Vec<Dim>(Vec<Dim>::Zero()), Vec<Dim>(Vec<Dim>::Constant(0.123))}) {
      SCOPED_TRACE(::testing::PrintToString(u.transpose()) + " at " + ::testing::PrintToString(at[0]));
      Cloud<Dim> even, ends, thrice;
      for (int i = -80; i <= 80; ++i) even.push_back(at + 0.05 * i * u);
      for (int i = 0; i < 160; ++i) ends.push_back(at + (i < 80 ? -4.0 + 0.01 * i : 3.0 + 0.01 * i - 0.8) * u);
      for (int i = -2; i <= 2; ++i) thrice.insert(thrice.end(), 3, at + 1.5 * i * u);
      EXPECT_EQ(verified_both<Dim>(even).nodes, 1);
      const SurfaceStatistics two = verified_both<Dim>(ends);
      EXPECT_EQ(two.fits + two.segments, 2);
      EXPECT_LT(verified_both<Dim>(thrice).certified(), 1e-6);  // Places far apart stand for themselves.
    }
}

TYPED_TEST(Degenerate, Coplanar) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  for (int trial = 0; trial < 8; ++trial) {
    SCOPED_TRACE(trial);
    const Vec<Dim> n = trial < Dim ? Vec<Dim>(Vec<Dim>::Unit(trial)) : Vec<Dim>(anywhere<Dim>(random, 1.0).normalized());
    const double offset = trial % 2 == 0 ? 0.0 : 0.777;
    Cloud<Dim> cloud;
    for (int i = 0; i < 6000; ++i) {
      Vec<Dim> p = anywhere<Dim>(random, 2.0);
      cloud.push_back(p + (offset - n.dot(p)) * n);
    }
    const SurfaceStatistics s = verified_both<Dim>(cloud, 0.25);
    EXPECT_LE(s.fits + s.segments + s.loose_points, 40);
  }
}

TYPED_TEST(Degenerate, OnCellFaces) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  for (const double step : {8.0, 4.0, 1.0, 0.25}) {  // Every coordinate a multiple: on the faces, edges and corners of the cube's cells.
    SCOPED_TRACE(step);
    Cloud<Dim> lattice, planes;
    const auto range = static_cast<std::uint64_t>(2.0 * 8.0 / step) + 1;
    for (int i = 0; i < 1500; ++i) {
      Vec<Dim> p;
      for (int a = 0; a < Dim; ++a) p[a] = -8.0 + step * static_cast<double>(random.below(range));
      lattice.push_back(p);
      p = anywhere<Dim>(random, 8.0);
      p[i % Dim] = -8.0 + step * static_cast<double>(random.below(range));
      planes.push_back(p);
    }
    for (const double eta : {0.01, 0.3}) {
      EXPECT_EQ(verified_both<Dim>(lattice, eta).points, 1500);
      EXPECT_EQ(verified_both<Dim>(planes, eta).points, 1500);
    }
  }
}

TYPED_TEST(Degenerate, InterleavedClustersThatNeverFit) {
  constexpr int Dim = TypeParam::value;
  Random random(4);
  Cloud<Dim> dust, layers;
  for (int i = 0; i < 600; ++i) {
    dust.push_back(Vec<Dim>::Constant(1.0) + anywhere<Dim>(random, 0.01));
    Vec<Dim> p = anywhere<Dim>(random, 0.1);
    p[0] = i % 2 == 0 ? 0.001 : -0.001;  // Two sheets a little more than eta apart.
    layers.push_back(p);
  }
  for (const std::int64_t depth : {0, 1, 5, 12, 24})
    for (const double eta : {1e-5, 0.0009})
      for (const Cloud<Dim>& cloud : {dust, layers})
        for (const bool paper : {false, true}) {
          SCOPED_TRACE(::testing::Message() << depth << ", eta " << eta << ", paper " << paper);
          const SurfaceStatistics s = verified<Dim>(cloud, cube<Dim>(), {.eta = eta, .max_depth = depth, .paper = paper});
          EXPECT_EQ(s.points, 600);
          if (depth <= 5) {
            EXPECT_EQ(s.depth, depth);
          }
        }
}

TYPED_TEST(Degenerate, NotANumberAndInfinities) {
  constexpr int Dim = TypeParam::value;
  Random random(5);
  const double wrong[] = {std::nan(""), kInfinity, -kInfinity};
  Cloud<Dim> cloud, clean;
  for (int i = 0; i < 600; ++i) {
    Vec<Dim> p = anywhere<Dim>(random, 5.0);
    p[0] = 2.0;
    clean.push_back(p);
    cloud.push_back(p);
    if (i % 2 == 0) p[i % Dim] = wrong[i % 3], cloud.push_back(p);
  }
  const SurfaceStatistics s = verified_both<Dim>(cloud, 0.5), t = verified_both<Dim>(clean, 0.5);
  EXPECT_EQ(s.not_finite, 300);
  EXPECT_EQ(s.points, t.points);
  EXPECT_EQ(s.nodes, t.nodes);
  EXPECT_EQ(s.fits, t.fits);
  EXPECT_EQ(s.certified(), t.certified());
  EXPECT_EQ(verified_both<Dim>(Cloud<Dim>(7, Vec<Dim>::Constant(kInfinity))).not_finite, 7);
}

TYPED_TEST(Degenerate, MillimetresAMillionMetresAway) {
  constexpr int Dim = TypeParam::value;
  Random random(6);
  Cloud<Dim> here, far;
  const Vec<Dim> shift = Vec<Dim>::Constant(1e6) + 2.5e5 * Vec<Dim>::Unit(0);
  for (int i = 0; i < 4000; ++i) {  // Steps of 4 mm on a wall.
    Vec<Dim> p = anywhere<Dim>(random, 0.5);
    p[0] = 0.004 * std::floor(5.0 * p[1] * p[1]);
    here.push_back(p);
    far.push_back(p + shift);
  }
  for (const double eta : {0.001, 0.02}) {
    const Box<Dim> domain = cube<Dim>(1.0), away{domain.low + shift, domain.high + shift};
    const SurfaceStatistics s = verified<Dim>(here, domain, {.eta = eta}), t = verified<Dim>(far, away, {.eta = eta});
    EXPECT_EQ(s.points, t.points);
    EXPECT_NEAR(static_cast<double>(s.nodes), static_cast<double>(t.nodes), 0.02 * static_cast<double>(s.nodes));  // Rounding moves a few.
    EXPECT_NEAR(s.certified(), t.certified(), 0.02 * eta);
  }
  verified_both<Dim>(far, 0.001);
}

TYPED_TEST(Degenerate, VastAndTinyDomains) {
  constexpr int Dim = TypeParam::value;
  Random random(7);
  for (const double scale : {1e-3, 1.0, 1e3, 1e6}) {
    SCOPED_TRACE(scale);
    Cloud<Dim> cloud;
    for (int i = 0; i < 800; ++i) {
      Vec<Dim> p = anywhere<Dim>(random, 1.0);
      if (i % 3 != 0) p[Dim - 1] = 0.2 * p[0];
      cloud.push_back(scale * p);
    }
    const double eta = std::clamp(0.02 * scale, 1e-5, 1e3);
    for (const bool paper : {false, true}) verified<Dim>(cloud, cube<Dim>(scale), {.eta = eta, .paper = paper});
  }
}

}  // namespace
}  // namespace vantage
