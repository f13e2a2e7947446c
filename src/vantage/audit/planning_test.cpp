// SPDX-License-Identifier: Apache-2.0
// The whole loop against an oracle that knows the map, and against the formulas as printed: guards the conventions of the metric.
#include <gtest/gtest.h>

#include <string>

#include "vantage/audit/trial.h"

namespace vantage {
namespace {

constexpr std::int64_t kStarts = 5;

/// Eq. (1) and the candidates by the letter of the paper's listing.
PlannerOptions as_printed(PlannerOptions o) {
  o.metric = PlannerOptions::Metric::boundary;
  o.elements = PlannerOptions::Elements::printed;
  o.facing = PlannerOptions::Facing::behind;
  o.mask = PlannerOptions::Mask::none;
  o.normalise = false;
  o.line_of_sight = false;
  o.printed_curvature = true;
  return o;
}

/// Scans for 99 % summed over the starts; a run that never gets there counts as three times its oracle.
struct Tally {
  std::int64_t oracle = 0, ours = 0, printed = 0;
  std::int64_t missed = 0, printed_missed = 0;
};

template <int Dim>
Tally tally(const Scene<Dim>& scene, const TrialOptions& options) {
  const Trial<Dim> trial(scene, options);
  TrialOptions printed = options;
  printed.explore.planner = as_printed(options.explore.planner);
  Tally sum;
  for (const Vec<Dim>& start : trial.starts(kStarts, 2026)) {
    const std::int64_t oracle = greedy_oracle(trial.sight_table(start, {.targets = 10000, .candidates = 500})).scans_to(0.99).value();
    const std::int64_t cap = 3 * oracle;
    const auto ours = trial.run(start, options, {.max_scans = cap, .coverage = 0.99}).scans_to(0.99);
    const auto theirs = trial.run(start, printed, {.max_scans = cap, .coverage = 0.99}).scans_to(0.99);
    sum.oracle += oracle;
    sum.ours += ours.value_or(cap);
    sum.printed += theirs.value_or(cap);
    sum.missed += ours ? 0 : 1;
    sum.printed_missed += theirs ? 0 : 1;
  }
  return sum;
}

void expect_close_to_the_oracle(const Tally& sum) {
  const std::string figures = "scans for 99 %: oracle " + std::to_string(sum.oracle) + ", ours " + std::to_string(sum.ours) + " (missed " +
                              std::to_string(sum.missed) + "), as printed " + std::to_string(sum.printed) + " (missed " + std::to_string(sum.printed_missed) + ")";
  SCOPED_TRACE(figures);
  EXPECT_EQ(sum.missed, 0);
  EXPECT_LE(static_cast<double>(sum.ours), 1.5 * static_cast<double>(sum.oracle));
  EXPECT_GE(static_cast<double>(sum.printed), 1.5 * static_cast<double>(sum.ours));
}

template <int Dim>
Scene<Dim> built_in(const std::string& name) {
  return std::get<Scene<Dim>>(make_scene(name));
}

TEST(Planning, Planar) {
  const Scene<2> scene = built_in<2>("planar");
  expect_close_to_the_oracle(tally(scene, trial_options(scene)));
}

TEST(Planning, Discs) {
  const Scene<2> scene = built_in<2>("discs");
  expect_close_to_the_oracle(tally(scene, trial_options(scene)));
}

TEST(Planning, Pipes) {
  const Scene<3> scene = built_in<3>("pipes:cylinders=6");
  TrialOptions options = trial_options(scene);
  options.explore.voxel = 0.5;
  options.lidar.pattern.step = radians(1.0);
  expect_close_to_the_oracle(tally(scene, options));
}

}  // namespace
}  // namespace vantage
