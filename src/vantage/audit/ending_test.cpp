// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/ending.h"

#include <gtest/gtest.h>

#include "vantage/world/inside_solid.h"

namespace vantage {
namespace {

template <class T>
class SmallScenes : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SmallScenes, Dimensions);

TYPED_TEST(SmallScenes, StartInTheOpenWithRoomAndComeAgain) {
  constexpr int Dim = TypeParam::value;
  for (std::size_t kind = 0; kind < small_kinds().size(); ++kind)
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const auto scene = make_small_scene<Dim>(static_cast<SmallKind>(kind), seed), again = make_small_scene<Dim>(static_cast<SmallKind>(kind), seed);
      SCOPED_TRACE(scene.name + " seed " + std::to_string(seed));
      const RayCaster<Dim> truth(scene.mesh);
      EXPECT_TRUE(scene.domain.contains(scene.start));
      EXPECT_GT(truth.distance(scene.start), scene.clearance);
      EXPECT_FALSE(inside_solid(truth, scene.start));
      EXPECT_EQ(scene.mesh.vertices, again.mesh.vertices);
      EXPECT_EQ(scene.mesh.facets, again.mesh.facets);
      EXPECT_EQ(scene.start, again.start);
    }
}

/// The mesh of a symmetric scene meets rays from its middle at the same ranges in mirrored directions.
TYPED_TEST(SmallScenes, TheSymmetricAreSymmetric) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto scene = make_small_scene<Dim>(SmallKind::symmetric, seed);
    const RayCaster<Dim> truth(scene.mesh);
    Vec<Dim> way = Vec<Dim>::Constant(0.31);
    way[0] = 0.77;
    way.normalize();
    const double range = truth.cast(scene.start, way).range;
    EXPECT_EQ(scene.start, scene.domain.center());
    for (int mirrored = 1; mirrored < (1 << Dim); ++mirrored) {
      Vec<Dim> other = way;
      for (int a = 0; a < Dim; ++a)
        if ((mirrored >> a & 1) != 0) other[a] = -other[a];
      EXPECT_NEAR(truth.cast(scene.start, other).range, range, 1e-9);
    }
  }
}

std::string story(const SmallScene& scene, const Ending& e) {
  return std::string(small_kinds()[static_cast<std::size_t>(scene.kind)]) + " " + std::to_string(scene.dim) + "D seed " + std::to_string(scene.seed) +
         ": " + e.error + e.reason + " share " + std::to_string(e.share) + ", said " + std::to_string(e.complete) + " " + std::to_string(e.low) +
         " .. " + std::to_string(e.high);
}

/// Whatever the place: every run ends by itself for the reason it gives, never stands in the same place twice and never hits anything.
TEST(Endings, EveryRunEndsAndHarmsNothing) {
  std::int64_t runs = 0, wrong = 0;
  double width = 0.0;
  const auto play = [&](const SmallScene& scene) {
    const Ending e = play_to_end(scene);
    SCOPED_TRACE(story(scene, e));
    EXPECT_EQ(e.error, "");
    EXPECT_TRUE(e.ended);
    EXPECT_TRUE(e.reason_true);
    EXPECT_EQ(e.repeated, 0);
    EXPECT_EQ(e.collisions, 0);
    EXPECT_EQ(e.unsafe, 0);
    ++runs;
    wrong += e.verdict_right ? 0 : 1;
    width += e.high - e.low;
  };
  for (std::size_t kind = 0; kind < small_kinds().size(); ++kind)
    for (std::uint64_t seed = 101; seed < 105; ++seed) play({static_cast<SmallKind>(kind), 2, seed});
  for (const SmallKind kind : {SmallKind::box, SmallKind::field, SmallKind::shut, SmallKind::pillar}) play({kind, 3, 101});
  EXPECT_LE(wrong, runs / 20) << wrong << " of " << runs;  // docs/10-audit.md has the share over thousands.
  EXPECT_LT(width / static_cast<double>(runs), 0.25);
}

/// A scanner that stands off where it says makes the map wrong, and the planner may then choose a place in a wall: the run goes on, and ends.
TEST(Endings, RunsWithNoiseOfThePoseEnd) {
  const auto scene = make_small_scene<2>(SmallKind::rooms, 101);
  for (std::int64_t seed = 1; seed <= 6; ++seed) {
    TrialOptions options = small_options(scene);
    options.lidar.pose_noise = 0.5 * scene.clearance;
    options.lidar.pose_turn = radians(1.0);
    options.lidar.seed = seed;
    const Ending e = play_to_end(scene, options);
    SCOPED_TRACE(story({SmallKind::rooms, 2, 101}, e));
    EXPECT_EQ(e.error, "");
    EXPECT_TRUE(e.ended);
    EXPECT_FALSE(e.reason.empty());
  }
}

/// The judge notices: a run cut short has not ended, and what it said of the rest holds nothing.
TEST(Endings, ARunCutShortHasNotEnded) {
  const auto scene = make_small_scene<2>(SmallKind::maze, 1);
  TrialOptions options = small_options(scene);
  options.explore.max_scans = 2;
  const Ending e = play_to_end(scene, options);
  EXPECT_FALSE(e.ended);
  EXPECT_FALSE(e.good());
  EXPECT_EQ(e.scans, 2);
}

}  // namespace
}  // namespace vantage
