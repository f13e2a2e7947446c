// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/certificate.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "vantage/audit/covering.h"
#include "vantage/audit/test_clouds.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"

namespace vantage {
namespace {

using test::anywhere;
using test::certificate_of;
using test::Cloud;

template <int Dim>
HausdorffTree<Dim> tree_of(const Cloud<Dim>& cloud, double eta = 0.1) {
  return test::reconstruct<Dim>(cloud, {.eta = eta});
}

template <int Dim>
CertificateReport check(const Cloud<Dim>& cloud, const std::vector<Patch<Dim>>& patches, const Certificate& claimed) {
  return check_certificate<Dim>(cloud, patches, claimed);
}

/// A few walls, a wire, and dust.
template <int Dim>
Cloud<Dim> clutter(std::uint64_t seed, int count) {
  Random random(seed);
  Cloud<Dim> cloud;
  for (int i = 0; i < count; ++i) {
    Vec<Dim> p = anywhere<Dim>(random, 1.0);
    switch (random.below(4)) {
      case 0: p[0] = -0.7; break;
      case 1: p[1] = 0.4 * p[0]; break;
      case 2: p = p[0] * Vec<Dim>::Constant(0.5) + 0.3 * Vec<Dim>::Unit(0); break;
      default:
        if (random.below(8) != 0) p[1] = 0.9;
    }
    cloud.push_back(p);
  }
  return cloud;
}

/// All pairs, with the distances of geometry/patch.
template <int Dim>
double brute_data_to_surface(const Cloud<Dim>& cloud, const std::vector<Patch<Dim>>& patches) {
  double worst = 0.0;
  for (const Vec<Dim>& p : cloud) {
    double least = kInfinity;
    for (const Patch<Dim>& patch : patches) least = std::min(least, distance(patch, p));
    worst = std::max(worst, least);
  }
  return worst;
}

/// Places of a patch: its corners and `count` random ones.
template <int Dim>
std::vector<Vec<Dim>> places_of(const Patch<Dim>& patch, int count, Random& random) {
  std::vector<Vec<Dim>> places(patch.corners().begin(), patch.corners().end());
  for (int s = 0; s < count && patch.count > 1; ++s) {
    Vec<Dim> p = Vec<Dim>::Zero();
    double sum = 0.0;
    for (const Vec<Dim>& corner : patch.corners()) {
      const double weight = -std::log(1.0 - random.uniform());  // Uniform over a triangle.
      p += weight * corner;
      sum += weight;
    }
    places.push_back(p / sum);
  }
  return places;
}

template <int Dim>
double nearest_in(const Cloud<Dim>& cloud, const Vec<Dim>& p) {
  double least2 = kInfinity;
  for (const Vec<Dim>& q : cloud) least2 = std::min(least2, (p - q).squaredNorm());
  return std::sqrt(least2);
}

template <int Dim>
Covering covering(const Patch<Dim>& patch, const Cloud<Dim>& cloud) {
  return covering_of<Dim>(patch, cloud, BoxTree<Dim>(cloud.size(), [&](std::uint32_t i) { return Box<Dim>{cloud[i], cloud[i]}; }));
}

template <class T>
class CertificateOf : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CertificateOf, Dims);

TYPED_TEST(CertificateOf, TreeHoldsAndMeasuresAgreeWithAllPairs) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(rc::check([] {
    const auto cloud = clutter<Dim>(*rc::gen::inRange(0, 1 << 20), *rc::gen::inRange(1, 250));
    const auto tree = tree_of<Dim>(cloud, *rc::gen::inRange(1, 40) * 0.01);
    const auto patches = tree.patches();
    const auto report = check<Dim>(cloud, patches, certificate_of(tree));
    RC_ASSERT(report.holds());
    RC_ASSERT(report.points == static_cast<std::int64_t>(cloud.size()));
    RC_ASSERT(std::abs(report.data_to_surface.max - brute_data_to_surface(cloud, patches)) < 1e-12);
    RC_ASSERT(report.data_to_surface.mean <= report.data_to_surface.max);
    RC_ASSERT(report.data_to_surface.p99 <= report.data_to_surface.max);
    RC_ASSERT(report.surface_to_data_low <= report.surface_to_data.max);
    RC_ASSERT(report.surface_to_data.max <= 1.001 * report.surface_to_data_low + 1e-12);
    Random random(5);
    for (const auto& patch : patches)
      for (const auto& place : places_of(patch, 20, random)) RC_ASSERT(nearest_in(cloud, place) <= report.surface_to_data.max + 1e-12);
  }));
}

/// Clouds whose patches have corners that rounding alone keeps apart: the certificate of the whole was up to six per cent too low.
TEST(CertificateOfClutter, HoldsWherePatchesHaveCornersThatAreOne) {
  struct Case {
    std::uint64_t seed;
    int count;
    double eta;
  };
  for (const Case& one : {Case{457974, 90, 0.24}, Case{107190, 132, 0.26}, Case{559774, 107, 0.23}}) {
    const auto cloud = clutter<3>(one.seed, one.count);
    const auto tree = tree_of<3>(cloud, one.eta);
    EXPECT_TRUE(check<3>(cloud, tree.patches(), certificate_of(tree)).holds()) << one.seed;
  }
}

TYPED_TEST(CertificateOf, CoveringIsBetweenSamplesAndTheirSpacing) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  for (int trial = 0; trial < 30; ++trial) {
    const auto cloud = clutter<Dim>(trial, 40);
    Patch<Dim> patch = segment_patch<Dim>(anywhere<Dim>(random, 1.0), anywhere<Dim>(random, 1.0));
    if constexpr (Patch<Dim>::kMaxVertices > 2) {  // In space a hexagon as well.
      const Vec<Dim> u = anywhere<Dim>(random, 0.5), w = anywhere<Dim>(random, 0.5);
      patch.count = 6;
      for (int i = 0; i < 6; ++i) patch.vertices[i] = sin_cos(i * kPi / 3.0)[0] * u + sin_cos(i * kPi / 3.0)[1] * w;
    }
    const Covering found = covering(patch, cloud);
    EXPECT_LE(found.low, found.high);
    EXPECT_LE(found.high, 1.001 * found.low + 1e-12);
    double sampled = 0.0;
    for (const auto& place : places_of(patch, 3000, random)) sampled = std::max(sampled, nearest_in(cloud, place));
    EXPECT_LE(sampled, found.high + 1e-12);
    EXPECT_GE(sampled, found.low - 0.08);
  }
}

TYPED_TEST(CertificateOf, CoveringInClosedForm) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> x = Vec<Dim>::Unit(0), y = Vec<Dim>::Unit(1);
  // Between two points, at a height: the middle is farthest.
  const Covering between = covering<Dim>(segment_patch<Dim>(Vec<Dim>::Zero(), 2.0 * x), {0.3 * y, 2.0 * x + 0.3 * y});
  EXPECT_LE(between.low, std::sqrt(1.09) + 1e-15);
  EXPECT_GE(between.high, std::sqrt(1.09) - 1e-15);
  const Covering one = covering<Dim>(segment_patch<Dim>(Vec<Dim>::Zero(), 2.0 * x), {0.5 * x});
  EXPECT_NEAR(one.low, 1.5, 1e-15);  // One point serves all: exact at once.
  EXPECT_NEAR(one.high, 1.5, 1e-15);
  const Covering point = covering<Dim>(point_patch<Dim>(3.0 * y), {y, -y});
  EXPECT_EQ(point.low, 2.0);
  EXPECT_EQ(point.high, 2.0);
  EXPECT_EQ(covering<Dim>(point_patch<Dim>(y), {}).low, kInfinity);
}

TEST(CertificateIn3d, SquareIsFarthestInTheMiddle) {
  Patch<3> square;
  for (const Vec<3>& v : {Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(1, 1, 0), Vec<3>(0, 1, 0)}) square.vertices[square.count++] = v;
  const Covering found = covering<3>(square, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_LE(found.low, std::sqrt(0.5) + 1e-15);
  EXPECT_GE(found.high, std::sqrt(0.5) - 1e-15);
  const FlatPiece<3> piece(square);
  EXPECT_NEAR(std::sqrt(piece.distance2(square, {0.4, 0.6, -2.0})), 2.0, 1e-15);
  EXPECT_NEAR(std::sqrt(piece.distance2(square, {1.3, 0.5, 0.4})), 0.5, 1e-15);
  EXPECT_NEAR(std::sqrt(piece.distance2(square, {-0.3, -0.4, 1.2})), 1.3, 1e-15);
}

TEST(CertificateIn3d, DistancesAgreeWithTrianglesOfAFan) {
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::inRange(0, 1 << 20));
    const Vec<3> u = anywhere<3>(random, 1.0), w = anywhere<3>(random, random.below(3) == 0 ? 1e-7 : 1.0), at = anywhere<3>(random, 2.0);
    Patch<3> patch;
    const int corners = 3 + static_cast<int>(random.below(6));
    const bool turned = random.below(2) == 0;
    for (int i = 0; i < corners; ++i) {
      const auto [s, c] = sin_cos((turned ? -i : i) * 2.0 * kPi / corners);
      patch.vertices[patch.count++] = at + c * u + s * w;
    }
    // Edges of next to no length, as cut corners leave them.
    if (patch.count < 8 && random.below(2) == 0) {
      const int at_corner = static_cast<int>(random.below(static_cast<std::uint64_t>(patch.count)));
      for (int i = patch.count++; i > at_corner; --i) patch.vertices[i] = patch.vertices[i - 1];
      patch.vertices[at_corner] += 1e-16 * anywhere<3>(random, 1.0);
    }
    const FlatPiece<3> piece(patch);
    for (int i = 0; i < 20; ++i) {
      const Vec<3> p = anywhere<3>(random, 3.0);
      RC_ASSERT(std::abs(std::sqrt(piece.distance2(patch, p)) - distance(patch, p)) < 1e-8);
    }
  }));
}

TYPED_TEST(CertificateOf, BoundsOfTheWholeAreWithinATenthOfTheTruth) {
  constexpr int Dim = TypeParam::value;
  Random random(41);
  for (int trial = 0; trial < 60; ++trial) {
    const double eta = std::array{0.05, 0.15, 0.5}[static_cast<std::size_t>(trial % 3)];
    const auto cloud = clutter<Dim>(100 + trial, 50 + static_cast<int>(random.below(3000)));
    const auto tree = tree_of<Dim>(cloud, eta);
    const auto report = check<Dim>(cloud, tree.patches(), certificate_of(tree));
    EXPECT_TRUE(report.holds()) << report.faults.front();
    EXPECT_TRUE(report.loose.empty()) << trial << ": " << report.loose.front();
  }
}

TYPED_TEST(CertificateOf, CorruptionIsCaught) {
  constexpr int Dim = TypeParam::value;
  const auto cloud = clutter<Dim>(3, 3000);
  const auto tree = tree_of<Dim>(cloud, 0.15);
  const auto good = tree.patches();
  const Certificate claimed = certificate_of(tree);
  ASSERT_TRUE(check<Dim>(cloud, good, claimed).holds());
  const auto widest = static_cast<std::size_t>(
      std::max_element(good.begin(), good.end(), [](const auto& a, const auto& b) { return a.surface_to_data < b.surface_to_data; }) - good.begin());
  const auto largest = static_cast<std::size_t>(
      std::max_element(good.begin(), good.end(), [](const auto& a, const auto& b) { return measure(a) < measure(b); }) - good.begin());

  auto patches = good;  // One patch says less than it is.
  patches[widest].surface_to_data *= 0.5F;
  auto report = check<Dim>(cloud, patches, claimed);
  EXPECT_EQ(report.wrong_patches, 1);
  ASSERT_EQ(report.faults.size(), 1U);
  EXPECT_NE(report.faults[0].find("patch " + std::to_string(widest)), std::string::npos) << report.faults[0];

  patches = good;  // The points of one patch are said to be nearer than they are.
  for (auto& patch : patches) patch.data_to_surface *= 0.5F;
  report = check<Dim>(cloud, patches, claimed);
  EXPECT_GT(report.unclaimed_points, 0);
  EXPECT_FALSE(report.holds());

  patches = good;  // A patch is lost.
  patches.erase(patches.begin() + static_cast<std::ptrdiff_t>(largest));
  report = check<Dim>(cloud, patches, claimed);
  EXPECT_GT(report.unclaimed_points, 3);
  EXPECT_GT(report.data_to_surface.max, claimed.data_to_surface);
  EXPECT_EQ(report.faults.size(), 2U);

  patches = good;  // A patch is somewhere else.
  for (int i = 0; i < patches[largest].count; ++i) patches[largest].vertices[i] += 3.0 * normal(good[largest]);
  report = check<Dim>(cloud, patches, claimed);
  EXPECT_EQ(report.wrong_patches, 1);
  EXPECT_GT(report.surface_to_data_low, 1.0);
  EXPECT_GT(report.unclaimed_points, 3);

  for (const double share : {0.98, 0.5, 0.0}) {  // The whole is said to be better than its parts.
    Certificate lower = claimed;
    lower.surface_to_data = share * check<Dim>(cloud, good, claimed).surface_to_data_low;
    EXPECT_FALSE(check<Dim>(cloud, good, lower).holds());
    lower = claimed;
    lower.data_to_surface = share * check<Dim>(cloud, good, claimed).data_to_surface.max;
    EXPECT_FALSE(check<Dim>(cloud, good, lower).holds());
  }
  Certificate vague = claimed;  // Right, but of no use.
  vague.data_to_surface *= 1.5;
  report = check<Dim>(cloud, good, vague);
  EXPECT_TRUE(report.holds());
  EXPECT_EQ(report.loose.size(), 1U);
}

TYPED_TEST(CertificateOf, NothingAndNotANumber) {
  constexpr int Dim = TypeParam::value;
  const auto nothing = check<Dim>({}, {}, {});
  EXPECT_TRUE(nothing.holds());
  EXPECT_EQ(nothing.data_to_surface.max, 0.0);
  EXPECT_EQ(nothing.surface_to_data.max, 0.0);

  const Vec<Dim> p = Vec<Dim>::Constant(1.0);
  const auto lost = check<Dim>({p}, {}, {.data_to_surface = 1.0, .surface_to_data = 1.0});
  EXPECT_EQ(lost.data_to_surface.max, kInfinity);
  EXPECT_EQ(lost.unclaimed_points, 1);
  EXPECT_FALSE(lost.holds());
  const auto invented = check<Dim>({}, {point_patch<Dim>(p)}, {.data_to_surface = 1.0, .surface_to_data = 1.0});
  EXPECT_EQ(invented.surface_to_data_low, kInfinity);
  EXPECT_FALSE(invented.holds());

  const auto counted = check<Dim>({p, Vec<Dim>::Constant(std::nan("")), Vec<Dim>::Constant(-kInfinity)}, {point_patch<Dim>(p)}, {});
  EXPECT_EQ(counted.not_finite, 2);
  EXPECT_EQ(counted.points, 1);
  EXPECT_TRUE(counted.holds());

  EXPECT_THROW(check<Dim>({p}, {point_patch<Dim>(Vec<Dim>::Constant(std::nan("")))}, {}), Error);
  auto no_corner = point_patch<Dim>(p);
  no_corner.count = 0;
  EXPECT_THROW(check<Dim>({p}, {no_corner}, {}), Error);
}

TYPED_TEST(CertificateOf, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto cloud = clutter<Dim>(8, 4000);
  const auto tree = tree_of<Dim>(cloud);
  const auto patches = tree.patches();
  CertificateReport one;
  {
    const ThreadLimit limit(1);
    one = check<Dim>(cloud, patches, certificate_of(tree));
  }
  const auto many = check<Dim>(cloud, patches, certificate_of(tree));
  EXPECT_EQ(one.data_to_surface.max, many.data_to_surface.max);
  EXPECT_EQ(one.data_to_surface.mean, many.data_to_surface.mean);
  EXPECT_EQ(one.surface_to_data.max, many.surface_to_data.max);
  EXPECT_EQ(one.surface_to_data.mean, many.surface_to_data.mean);
  EXPECT_EQ(one.surface_to_data_low, many.surface_to_data_low);
}

TYPED_TEST(CertificateOf, TellsTheObserverAndStops) {
  constexpr int Dim = TypeParam::value;
  class Impatient final : public Observer {
   public:
    void stage(std::string_view name) override { heard.emplace_back(name); }
    bool stop_requested() override { return heard.size() > 1; }
    std::vector<std::string> heard;
  };
  const auto cloud = clutter<Dim>(9, 100);
  const auto tree = tree_of<Dim>(cloud);
  Impatient observer;
  EXPECT_THROW(static_cast<void>(check_certificate<Dim>(cloud, tree.patches(), certificate_of(tree), &observer)), Error);
  EXPECT_EQ(observer.heard, (std::vector<std::string>{"verify points 0 %", "verify patches 0 %"}));
}

}  // namespace
}  // namespace vantage
