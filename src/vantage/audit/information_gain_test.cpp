// SPDX-License-Identifier: Apache-2.0
// Gains of hand-made maps beside a count by small steps; only where OctoMap is found.
#include "vantage/audit/information_gain.h"

#include <gtest/gtest.h>

#include <set>

#include "vantage/audit/trial.h"
#include "vantage/base/error.h"
#include "vantage/planner/ray_march.h"

namespace vantage {
namespace {

/// Gives scans made by hand.
class Handmade final : public Sensor<2> {
 public:
  explicit Handmade(Scan<2> scan) : scan_(std::move(scan)) {}
  [[nodiscard]] Scan<2> scan(const Vec<2>& /*vantage_point*/, int /*index*/) override { return scan_; }

 private:
  Scan<2> scan_;
};

using Cell = std::pair<int, int>;
/// Cells are centred on whole numbers.
Cell cell(const Vec<2>& p) { return {static_cast<int>(std::floor(p[0] + 0.5)), static_cast<int>(std::floor(p[1] + 0.5))}; }

constexpr double kRange = 30.0;

/// From the middle (10, 10) of a square of 20 m: walls of the given cells in front, at their near sides; nothing elsewhere.
struct Map {
  Box<2> domain{{0.0, 0.0}, {20.0, 20.0}};
  Scan<2> scan;
  std::set<Cell> free, occupied;

  explicit Map(const std::set<Cell>& walls) : occupied() {
    scan.origin = {10.0, 10.0};
    scan.pattern.step = radians(0.5);
    scan.pattern.max_range = kRange;
    for (const Vec<2>& d : directions<2>(scan.pattern)) {
      float range = kNoReturn;
      for (double r = 0.0; r < kRange && range == kNoReturn; r += 0.001)
        if (walls.contains(cell(scan.origin + r * d)))
          range = static_cast<float>(r), occupied.insert(cell(scan.origin + r * d));
        else
          free.insert(cell(scan.origin + r * d));
      scan.ranges.push_back(range);
    }
  }

  /// What the definition says, by small steps.
  [[nodiscard]] std::int64_t gain(const Vec<2>& from, std::size_t rays) const {
    std::int64_t count = 0;
    for (const Vec<2>& d : spread_directions<2>(rays, 1)) {
      std::set<Cell> unknown;
      for (double r = 0.0; r < kRange && domain.contains(from + r * d); r += 0.001) {
        const Cell c = cell(from + r * d);
        if (occupied.contains(c)) break;
        if (!free.contains(c)) unknown.insert(c);
      }
      count += static_cast<std::int64_t>(unknown.size());
    }
    return count;
  }
};

TEST(InformationGain, CountsUnknownVoxelsUpToTheFirstWall) {
  if (!has_octomap()) GTEST_SKIP() << "no OctoMap";
  std::set<Cell> walls;
  for (int k = 5; k <= 15; ++k) walls.insert({14, k}), walls.insert({k, 4});
  const Map map(walls);
  Handmade sensor(map.scan);
  InformationGain<2> peer(sensor, map.domain, {.voxel = 1.0});
  (void)peer.scan(map.scan.origin, 0);
  // Where the scan was, beside a wall, past it, behind the walls; none on the edge of a shadow, where a cell near by is known or not by a hair.
  const std::vector<Vec<2>> places{{10.0, 10.0}, {13.0, 10.0}, {12.0, 18.0}, {18.0, 10.0}, {6.0, 2.0}, {10.0, 2.0}};
  const std::vector<std::int64_t> gains = peer.gains(places);
  std::int64_t largest = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::int64_t by_hand = map.gain(places[i], rays_in<2>(4050));
    // Cells at the edge of a shadow may differ.
    EXPECT_NEAR(static_cast<double>(gains[i]), static_cast<double>(by_hand), 0.06 * static_cast<double>(by_hand) + 20.0) << "place " << i;
    largest = std::max(largest, by_hand);
  }
  EXPECT_GT(largest, 1000);
  EXPECT_LT(gains[0], gains[3] / 10);  // Where the scan was, hardly anything is unknown; behind the wall much is.
}

TEST(InformationGain, IsNoneInAClosedRoom) {
  if (!has_octomap()) GTEST_SKIP() << "no OctoMap";
  std::set<Cell> walls;
  for (int k = 3; k <= 17; ++k)
    for (const int side : {3, 17}) walls.insert({side, k}), walls.insert({k, side});
  const Map map(walls);
  Handmade sensor(map.scan);
  InformationGain<2> peer(sensor, map.domain, {.voxel = 1.0});
  (void)peer.scan(map.scan.origin, 0);
  EXPECT_EQ(peer.gains(std::vector<Vec<2>>{{10.0, 10.0}, {6.0, 13.0}}), (std::vector<std::int64_t>{0, 0}));
}

TEST(InformationGain, PilotsARun) {
  const Scene<2> scene = std::get<Scene<2>>(make_scene("planar:blobs=3"));
  TrialOptions options = trial_options(scene);
  options.information_gain = true;
  const Trial<2> trial(scene, options);
  if (!has_octomap()) {
    EXPECT_THROW((void)trial.run(scene.start, options, {.max_scans = 3}), Error);
    return;
  }
  const RunScore<2> run = trial.run(scene.start, options, {.max_scans = 12, .coverage = 0.95});
  ASSERT_GE(run.places.size(), 3U);
  EXPECT_GE(run.coverage.back(), 0.95);
  options.information_gain = false;
  EXPECT_NE(trial.run(scene.start, options, {.max_scans = 12, .coverage = 0.95}).places[1], run.places[1]);
  for (std::size_t k = 1; k < run.places.size(); ++k) EXPECT_GE(run.path[k] - run.path[k - 1], (run.places[k] - run.places[k - 1]).norm() - 1e-9);
}

}  // namespace
}  // namespace vantage
