// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/score.h"

#include <gtest/gtest.h>

#include "vantage/audit/trial.h"

namespace vantage {
namespace {

TEST(IdlePicks, CountedUpToTheScanThatReaches99Percent) {
  EXPECT_EQ(idle_picks({}), 0);
  EXPECT_EQ(idle_picks(std::vector<double>{0.0004, 0.5, 0.5009, 0.9, 0.9}), 2);        // The first scan is no pick.
  EXPECT_EQ(idle_picks(std::vector<double>{0.5, 0.98, 0.9899, 0.99, 0.99, 0.99}), 1);  // What comes after 99 % does not count.
  EXPECT_EQ(idle_picks(std::vector<double>{0.995, 0.995}), 0);
}

TEST(VerdictRight, NeedsTheRightWordAndTheRightBounds) {
  Verdict<3> verdict;
  verdict.complete = true;
  verdict.seen_low = 0.98;
  verdict.seen_high = 0.999;
  const auto right = [&](double share, double widely) { return verdict_right(verdict, {share, widely, 0.0}); };
  EXPECT_TRUE(right(0.99, 0.99));
  EXPECT_TRUE(right(0.995, 0.995));
  EXPECT_TRUE(right(0.97, 0.995));      // What is missing shows through slits alone.
  EXPECT_FALSE(right(0.985, 0.985));    // Not complete, though within the bounds.
  EXPECT_FALSE(right(0.97, 0.985));     // Nor that.
  EXPECT_FALSE(right(0.9995, 0.9995));  // Complete, but beyond the bounds.
  verdict.complete = false;
  EXPECT_TRUE(right(0.985, 0.985));
  EXPECT_TRUE(right(0.985, 1.0));
  EXPECT_FALSE(right(0.975, 0.975));
  EXPECT_FALSE(right(0.995, 0.995));
  EXPECT_FALSE(right(0.995, 1.0));
}

/// A run in a small scene, and what must hold of any score.
TEST(ScoreRun, FollowsTheExplorer) {
  const auto scene = std::get<Scene<2>>(make_scene("discs:discs=2"));
  TrialOptions options = trial_options(scene);
  options.explore.voxel = 0.5;
  options.explore.max_scans = 12;
  const Trial<2> trial(scene, options);
  const RunScore<2> score = trial.run(scene.start, options);
  ASSERT_FALSE(score.coverage.empty());
  EXPECT_EQ(score.places.size(), score.coverage.size());
  EXPECT_EQ(score.places[0], scene.start);
  EXPECT_TRUE(score.finished);
  for (std::size_t k = 1; k < score.coverage.size(); ++k)  // The union never forgets; only what turns out to be beside an obstacle is taken back.
    EXPECT_GE(score.coverage[k], score.coverage[k - 1] - 0.002);
  EXPECT_EQ(score.verdict_right, verdict_right(score.verdict, score.last));
  EXPECT_EQ(score.last.fraction, score.coverage.back());
  EXPECT_GT(score.coverage.back(), 0.95);
  ASSERT_EQ(score.path.size(), score.places.size());
  EXPECT_GE(score.path.back(), (score.places.back() - score.places.front()).norm() * 0.999);
}

TEST(ScoreRun, StopsAtItsLimits) {
  const auto scene = std::get<Scene<2>>(make_scene("discs"));
  TrialOptions options = trial_options(scene);
  options.explore.voxel = 0.5;
  const Trial<2> trial(scene, options);
  const RunScore<2> two = trial.run(scene.start, options, {.max_scans = 2});
  EXPECT_EQ(two.coverage.size(), 2U);
  EXPECT_FALSE(two.finished);
  EXPECT_FALSE(two.verdict_right);
  const RunScore<2> enough = trial.run(scene.start, options, {.coverage = 0.5 * two.coverage[0]});
  EXPECT_EQ(enough.coverage, std::vector<double>{two.coverage[0]});
}

TEST(Trial, StartsAreReachableAndSeeded) {
  const auto scene = std::get<Scene<2>>(make_scene("planar"));
  const Trial<2> trial(scene, trial_options(scene));
  const auto starts = trial.starts(20, 1);
  const RayCaster<2> truth(scene.mesh);
  for (const Vec<2>& p : starts) {
    EXPECT_TRUE(scene.domain.contains(p));
    EXPECT_GE(truth.distance(p), scene.clearance);
  }
  EXPECT_EQ(trial.starts(20, 1), starts);
  EXPECT_NE(trial.starts(20, 2), starts);
}

TEST(Trial, OptionsAreTheScenes) {
  const auto scene = std::get<Scene<3>>(make_scene("pipes"));
  const TrialOptions options = trial_options(scene);
  EXPECT_EQ(options.explore.voxel, scene.voxel);
  EXPECT_EQ(options.explore.surface.eta, scene.eta);
  EXPECT_EQ(options.explore.planner.clearance, scene.clearance);
  EXPECT_EQ(options.lidar.pattern.max_range, scene.range);
}

}  // namespace
}  // namespace vantage
