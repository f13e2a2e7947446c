// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/surface.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/surface/test_clouds.h"

namespace vantage {
namespace {

template <class T>
class Surface : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Surface, Dims);

TYPED_TEST(Surface, CertificateHoldsForEveryPointAndPlace) {
  constexpr int Dim = TypeParam::value;
  for (const double eta : {0.05, 0.3, 1.0}) {
    const auto cloud = scene<Dim>(1, 3000);
    const auto tree = tree_of<Dim>(cloud, {.eta = eta});
    expect_certified(tree, cloud);
    EXPECT_GT(tree.statistics().fits + tree.statistics().segments, 0);
  }
}

TYPED_TEST(Surface, CertificateHoldsForRandomSets) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(rc::check([] {
    const auto count = *rc::gen::inRange<int>(0, 60);
    const auto steps = *rc::gen::element(3, 20, 1000);
    const double eta = *rc::gen::element(0.02, 0.2, 1.0, 4.0);
    const auto depth = *rc::gen::element<std::int64_t>(0, 2, 14);
    Cloud<Dim> cloud;
    for (int i = 0; i < count; ++i) {
      Vec<Dim> p;
      for (int a = 0; a < Dim; ++a) p[a] = -5.0 + 10.0 * *rc::gen::inRange(0, steps + 1) / steps;
      cloud.push_back(p);
    }
    expect_certified(tree_of<Dim>(cloud, {.eta = eta, .max_depth = depth}), cloud);
    RC_ASSERT(!::testing::Test::HasFailure());
  }));
}

TYPED_TEST(Surface, TreeDependsOnTheSetAlone) {
  constexpr int Dim = TypeParam::value;
  const auto cloud = scene<Dim>(3, 4000), extra = scene<Dim>(4, 700);
  const auto batch = tree_of<Dim>(cloud);

  Cloud<Dim> shuffled = cloud;
  Random random(5);
  for (std::size_t i = shuffled.size(); i > 1; --i) std::swap(shuffled[i - 1], shuffled[random.below(i)]);
  expect_same(batch, tree_of<Dim>(shuffled));

  for (const std::size_t part : {1000U, 333U, 41U}) {
    HausdorffTree<Dim> incremental(domain<Dim>(), {});
    for (std::size_t i = 0; i < shuffled.size(); i += part) incremental.insert(std::span(shuffled).subspan(i, std::min(part, shuffled.size() - i)));
    expect_same(batch, incremental);
  }

  HausdorffTree<Dim> removed = tree_of<Dim>(extra);
  removed.insert(shuffled);
  EXPECT_EQ(removed.remove(extra).points, static_cast<std::int64_t>(extra.size()));
  expect_same(batch, removed);
  removed.remove(shuffled);
  expect_same(removed, HausdorffTree<Dim>(domain<Dim>(), {}));
}

TYPED_TEST(Surface, DenseScansOneAfterTheOtherEndInTheSameTree) {
  constexpr int Dim = TypeParam::value;
  for (const double eta : {0.3, 0.8, 2.0}) {
    const SurfaceOptions options{.eta = eta};
    Cloud<Dim> all;
    HausdorffTree<Dim> tree(domain<Dim>(), options);
    for (int scan = 0; scan < 10; ++scan) {  // Large leaves stand, planes are refused, and both come to an end.
      const auto points = scene<Dim>(100 + scan, scan % 3 == 0 ? 8000 : 700);
      tree.insert(points);
      all.insert(all.end(), points.begin(), points.end());
      if (scan % 2 == 0) expect_same(tree_of<Dim>(all, options), tree);
    }
    const auto last = scene<Dim>(109, 8000);
    tree.remove(last);
    tree.insert(last);
    expect_same(tree_of<Dim>(all, options), tree);
  }
}

TYPED_TEST(Surface, RandomHistoriesEndInTheSameTree) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(rc::check([] {
    const std::uint64_t seed = *rc::gen::arbitrary<std::uint64_t>();
    const double eta = *rc::gen::element(0.1, 0.5, 2.0);
    const bool paper = *rc::gen::arbitrary<bool>();
    const SurfaceOptions options{.eta = eta, .max_depth = 6, .paper = paper};
    Random random(seed);
    Cloud<Dim> kept;
    HausdorffTree<Dim> tree(domain<Dim>(), options);
    for (int round = 0; round < 6; ++round) {
      const auto added = scene<Dim>(random.next(), random.below(300));
      tree.insert(added);
      if (random.below(2) == 0) {
        tree.remove(added);
      } else {
        kept.insert(kept.end(), added.begin(), added.end());
      }
    }
    expect_same(tree, tree_of<Dim>(kept, options));
    RC_ASSERT(!::testing::Test::HasFailure());
  }));
}

TYPED_TEST(Surface, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto cloud = scene<Dim>(6, 20000);
  const auto first = tree_of<Dim>(cloud);
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    HausdorffTree<Dim> tree(domain<Dim>(), {});
    tree.insert(std::span(cloud).first(cloud.size() / 2));
    tree.insert(std::span(cloud).subspan(cloud.size() / 2));
    expect_same(first, tree);
  }
}

TYPED_TEST(Surface, PlaneIsOneFit) {
  constexpr int Dim = TypeParam::value;
  Random random(7);
  Cloud<Dim> cloud;
  for (int i = 0; i < 4000; ++i) {
    Vec<Dim> p = anywhere<Dim>(random, 5.0);
    p[0] = 0.3 * p[1] + 1.0;
    cloud.push_back(p);
  }
  const auto tree = tree_of<Dim>(cloud, {.eta = 1.0});
  const auto patches = tree.patches();
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_EQ(tree.statistics().nodes, 1);
  EXPECT_LT(patches[0].data_to_surface, 1e-4);
  EXPECT_NEAR(std::abs(normal(patches[0])[0]), 1.0 / std::sqrt(1.09), 1e-6);
  // The plane clipped to the cube: the fit reaches the domain's faces.
  EXPECT_NEAR(patches[0].bounds().low[1], -5.0, 1e-6);
  EXPECT_NEAR(patches[0].bounds().high[1], 5.0, 1e-6);
}

TYPED_TEST(Surface, CornerIsFewFits) {
  constexpr int Dim = TypeParam::value;
  Random random(8);
  Cloud<Dim> cloud;
  for (int i = 0; i < 6000; ++i) {
    Vec<Dim> p = anywhere<Dim>(random, 1.0);
    p[i % 2] = -1.0;
    if (p[1 - i % 2] > 0.5 && i % 2 == 0) continue;
    cloud.push_back(p);
  }
  const auto tree = tree_of<Dim>(cloud, {.eta = 0.3});
  EXPECT_LE(tree.statistics().fits, Dim == 2 ? 6 : 40);
  EXPECT_EQ(tree.statistics().loose_points, 0);
  expect_certified(tree, cloud);
}

TYPED_TEST(Surface, WireIsKeptByFewSegments) {
  constexpr int Dim = TypeParam::value;
  Random random(9);
  const Vec<Dim> along = anywhere<Dim>(random, 1.0).normalized();
  Cloud<Dim> cloud;
  for (double s = -4.5; s < 4.5; s += 0.11) cloud.push_back(s * along + anywhere<Dim>(random, 0.003));
  const auto tree = tree_of<Dim>(cloud);
  expect_certified(tree, cloud);
  EXPECT_LE(tree.patches().size(), 4U);
  for (double s = -4.5; s < 4.4; s += 0.01) EXPECT_LT(distance_to(tree.patches(), Vec<Dim>(s * along)), 0.1);
}

TYPED_TEST(Surface, GapIsNotBridged) {
  constexpr int Dim = TypeParam::value;
  Random random(10);
  Cloud<Dim> cloud;
  while (cloud.size() < 5000) {
    Vec<Dim> p = anywhere<Dim>(random, 3.0);
    p[0] = 0.5;
    if (std::abs(p[1]) > 0.8) cloud.push_back(p);
  }
  const auto tree = tree_of<Dim>(cloud, {.eta = 0.4});
  EXPECT_GT(distance_to(tree.patches(), Vec<Dim>(0.5 * Vec<Dim>::Unit(0))), 0.39);
  expect_certified(tree, cloud);
}

TYPED_TEST(Surface, DegenerateInput) {
  constexpr int Dim = TypeParam::value;
  EXPECT_EQ(tree_of<Dim>({}).statistics().nodes, 1);
  EXPECT_TRUE(tree_of<Dim>({}).patches().empty());

  const Cloud<Dim> few(3, Vec<Dim>::Constant(1.25));
  EXPECT_EQ(tree_of<Dim>(few).statistics().loose_points, 1);  // Duplicates count once.
  const Cloud<Dim> equal(500, Vec<Dim>::Constant(0.0));
  EXPECT_EQ(tree_of<Dim>(equal).patches().size(), 1U);
  expect_certified(tree_of<Dim>(equal), equal);

  Cloud<Dim> collinear, faces, interleaved;
  for (int i = 0; i <= 160; ++i) {
    collinear.push_back(Vec<Dim>::Unit(0) * (i / 16.0 - 5.0));
    Vec<Dim> p = Vec<Dim>::Zero();
    p[1] = i / 16.0 - 5.0;
    p[i % Dim] = 2.5;
    faces.push_back(p);
  }
  expect_certified(tree_of<Dim>(collinear), collinear);
  EXPECT_LE(tree_of<Dim>(collinear).patches().size(), 2U);
  expect_certified(tree_of<Dim>(faces), faces);

  Random random(11);
  for (int i = 0; i < 4000; ++i) interleaved.push_back(anywhere<Dim>(random, 0.05));
  for (const bool paper : {false, true}) {
    const auto tree = tree_of<Dim>(interleaved, {.eta = 0.0005, .max_depth = 8, .paper = paper});
    EXPECT_EQ(tree.statistics().depth, 8);
    if (!paper) expect_certified(tree, interleaved);
  }
}

TYPED_TEST(Surface, WhatDoesNotBelongIsCounted) {
  constexpr int Dim = TypeParam::value;
  auto cloud = scene<Dim>(12, 500);
  const auto clean = tree_of<Dim>(cloud);
  HausdorffTree<Dim> tree = tree_of<Dim>(cloud);
  Cloud<Dim> bad = {Vec<Dim>::Constant(std::nan("")), Vec<Dim>::Constant(kInfinity), Vec<Dim>::Constant(5.001), Vec<Dim>::Constant(-1e300)};
  EXPECT_EQ(tree.insert(bad).points, 0);
  EXPECT_EQ(tree.statistics().not_finite, 2);
  EXPECT_EQ(tree.statistics().outside, 2);
  EXPECT_TRUE(same_patches(tree.patches(), clean.patches()));
  EXPECT_EQ(tree.remove(bad).points, 0);
  expect_same(tree, clean);
  // On the domain's own faces: inside.
  EXPECT_EQ(tree.insert(Cloud<Dim>{Vec<Dim>::Constant(5.0), Vec<Dim>::Constant(-5.0)}).points, 2);
}

TYPED_TEST(Surface, FarFromTheOriginNothingIsLost) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> shift = Vec<Dim>::Constant(1048576.0);  // A power of two: the same sites.
  const auto cloud = scene<Dim>(13, 2000);
  Cloud<Dim> far;
  for (const Vec<Dim>& p : cloud) far.push_back(p + shift);
  HausdorffTree<Dim> tree({domain<Dim>().low + shift, domain<Dim>().high + shift}, {.eta = 0.01});
  tree.insert(far);
  EXPECT_EQ(tree.statistics().points, static_cast<std::int64_t>(far.size()));
  expect_certified(tree, far, 1);
}

TYPED_TEST(Surface, UpdateBoxCoversEveryChangedPatch) {
  constexpr int Dim = TypeParam::value;
  HausdorffTree<Dim> tree(domain<Dim>(), {});
  Random random(14);
  for (int round = 0; round < 12; ++round) {
    const auto before = tree.patches();
    const Vec<Dim> at = anywhere<Dim>(random, 4.0);
    Cloud<Dim> added;
    for (const Vec<Dim>& p : scene<Dim>(20 + round, 2000))
      if ((p - at).norm() < 1.5) added.push_back(p);
    const auto update = tree.insert(added);
    EXPECT_EQ(update.points, static_cast<std::int64_t>(added.size()));
    const auto after = tree.patches();
    const auto missing = [](const std::vector<Patch<Dim>>& from, const std::vector<Patch<Dim>>& in) {
      std::vector<Patch<Dim>> out;
      for (const auto& p : from)
        if (std::none_of(in.begin(), in.end(), [&](const auto& q) { return same_patches<Dim>({p}, {q}); })) out.push_back(p);
      return out;
    };
    for (const auto& changed : {missing(before, after), missing(after, before)})
      for (const auto& patch : changed)
        for (const auto& corner : patch.corners()) EXPECT_TRUE(update.changed.contains(corner));
  }
}

TYPED_TEST(Surface, BoxQueryFindsAllThatMeetIt) {
  constexpr int Dim = TypeParam::value;
  const auto tree = tree_of<Dim>(scene<Dim>(15, 6000), {.eta = 0.3});
  Random random(16);
  for (int i = 0; i < 50; ++i) {
    const Vec<Dim> center = anywhere<Dim>(random, 5.0);
    const Box<Dim> box = Box<Dim>{center, center}.grown(random.uniform(0.0, 2.0));
    std::vector<Patch<Dim>> expected;
    for (const auto& patch : tree.patches())
      if (!patch.bounds().intersection(box).empty()) expected.push_back(patch);
    auto found = tree.patches(box);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {  // With bounds that took no work.
      EXPECT_GE(found[k].data_to_surface, expected[k].data_to_surface);
      EXPECT_GE(found[k].surface_to_data, expected[k].surface_to_data);
      EXPECT_LE(found[k].surface_to_data, 0.3F);
      found[k].data_to_surface = expected[k].data_to_surface;
      found[k].surface_to_data = expected[k].surface_to_data;
    }
    EXPECT_TRUE(same_patches(found, expected));
  }
}

TYPED_TEST(Surface, PaperModeDropsPointsAndSaysSo) {
  constexpr int Dim = TypeParam::value;
  const auto cloud = scene<Dim>(17, 3000);
  const SurfaceOptions options{.eta = 0.05, .max_depth = 7, .paper = true};
  const auto tree = tree_of<Dim>(cloud, options);
  const auto statistics = tree.statistics();
  EXPECT_EQ(statistics.loose_points, 0);
  EXPECT_EQ(statistics.segments, 0);
  EXPECT_GT(statistics.data_to_surface, statistics.eta);  // As in Table I.
  EXPECT_NEAR(data_to_surface(cloud, tree.patches()), statistics.data_to_surface, 1e-6);
  EXPECT_LE(surface_to_data(tree.patches(), cloud, 4), statistics.surface_to_data);
}

TYPED_TEST(Surface, WrongOptionsAreRefused) {
  constexpr int Dim = TypeParam::value;
  using Tree = HausdorffTree<Dim>;
  EXPECT_THROW(Tree(domain<Dim>(), {.eta = 0.0}), Error);
  EXPECT_THROW(Tree(domain<Dim>(), {.eta = -0.1}), Error);
  EXPECT_THROW(Tree(domain<Dim>(), {.eta = std::nan("")}), Error);
  EXPECT_THROW(Tree(domain<Dim>(), {.max_depth = -1}), Error);
  EXPECT_THROW(Tree(domain<Dim>(), {.min_points = -1}), Error);
  EXPECT_THROW(Tree(Box<Dim>{}, {}), Error);
  EXPECT_THROW(Tree({Vec<Dim>::Zero(), Vec<Dim>::Zero()}, {}), Error);
  EXPECT_THROW(Tree(domain<Dim>(1e6), {.eta = 1e-3}), Error);  // Below what the lattice resolves.
}

}  // namespace
}  // namespace vantage
