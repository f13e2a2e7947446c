// SPDX-License-Identifier: Apache-2.0
#include "vantage/explore/explore.h"

#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

template <class T>
class Explore : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Explore, Dimensions);

/// A scanner in an analytic world: balls in the open, or inside a closed room.
template <int Dim>
class BallWorld final : public Sensor<Dim> {
 public:
  std::vector<std::pair<Vec<Dim>, double>> balls;
  double room = kInfinity;  ///< Half side of the room about the origin.
  double step_deg = 2.0;

  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>& at, int /*index*/) override {
    Scan<Dim> scan;
    scan.origin = at;
    scan.pattern.step = radians(step_deg);
    scan.pattern.max_range = 30.0;
    for (const Vec<Dim>& d : directions<Dim>(scan.pattern)) {
      const double range = first_hit(at, d);
      scan.ranges.push_back(range <= 30.0 ? static_cast<float>(range) : kNoReturn);
    }
    return scan;
  }

 private:
  [[nodiscard]] double first_hit(const Vec<Dim>& at, const Vec<Dim>& d) const {
    double nearest = kInfinity;
    for (const auto& [center, radius] : balls) {
      const Vec<Dim> offset = center - at;
      const double along = offset.dot(d), off2 = offset.squaredNorm() - along * along;
      if (along > 0.0 && off2 < radius * radius) nearest = std::min(nearest, along - std::sqrt(radius * radius - off2));
    }
    for (int a = 0; a < Dim && std::isfinite(room); ++a)
      if (d[a] != 0.0) nearest = std::min(nearest, ((d[a] > 0.0 ? room : -room) - at[a]) / d[a]);
    return nearest;
  }
};

template <int Dim>
Box<Dim> cube(double half_side) {
  return {Vec<Dim>::Constant(-half_side), Vec<Dim>::Constant(half_side)};
}

template <int Dim>
ExploreOptions coarse() {
  ExploreOptions options;
  options.voxel = 0.4;
  options.surface.eta = 0.08;
  options.planner.clearance = 0.4;
  options.max_scans = 60;
  return options;
}

template <int Dim>
BallWorld<Dim> two_balls() {
  BallWorld<Dim> world;
  Vec<Dim> left = Vec<Dim>::Zero(), right = left;
  left[0] = -2.0;
  right[0] = 2.0;
  right[1] = 1.0;
  world.balls = {{left, 1.0}, {right, 1.2}};
  return world;
}

template <int Dim>
Vec<Dim> corner() {
  return Vec<Dim>::Constant(-4.0);
}

template <int Dim>
void run(Explorer<Dim>& explorer) {
  while (!explorer.finished()) explorer.step();
}

TYPED_TEST(Explore, SeesAllOfAPlaceWithTwoObstacles) {
  constexpr int Dim = TypeParam::value;
  BallWorld<Dim> world = two_balls<Dim>();
  Explorer<Dim> explorer(world, cube<Dim>(5.0), corner<Dim>(), coarse<Dim>());
  run(explorer);
  EXPECT_TRUE(explorer.verdict().complete) << explorer.verdict().reason;
  const Field<Dim, NodeState> states = explorer.states();
  std::int64_t missed = 0, free = 0;
  for (std::size_t i = 0; i < states.values.size(); ++i) {
    const Vec<Dim> p = states.window.position(i);
    double clearance = kInfinity;
    for (const auto& [center, radius] : world.balls) clearance = std::min(clearance, (p - center).norm() - radius);
    if (clearance < -0.1) {
      EXPECT_NE(states[i], NodeState::seen) << p.transpose();  // Never falsely free.
    }
    if (clearance < 0.4) continue;
    ++free;
    missed += states[i] != NodeState::seen;
  }
  EXPECT_LE(missed, free / 100);
}

TYPED_TEST(Explore, PathsAreJoinedAndKeepClear) {
  constexpr int Dim = TypeParam::value;
  BallWorld<Dim> world = two_balls<Dim>();
  Explorer<Dim> explorer(world, cube<Dim>(5.0), corner<Dim>(), coarse<Dim>());
  run(explorer);
  const auto& path = explorer.path();
  ASSERT_GE(path.size(), 2U);
  EXPECT_LT((path.front() - corner<Dim>()).norm(), 1e-9);
  for (std::size_t i = 1; i < path.size(); ++i)
    for (double t = 0.0; t <= 1.0; t += 0.02) {
      const Vec<Dim> p = path[i - 1] + t * (path[i] - path[i - 1]);
      for (const auto& [center, radius] : world.balls) EXPECT_GT((p - center).norm(), radius);
    }
  for (const auto& record : explorer.steps())
    for (const auto& other : explorer.steps()) {
      if (record.scan != other.scan) {
        EXPECT_GT((record.vantage - other.vantage).norm(), 0.4);  // No vantage point twice.
      }
    }
}

TYPED_TEST(Explore, AnOpenFieldAndAClosedRoomAreDoneAtOnce) {
  constexpr int Dim = TypeParam::value;
  BallWorld<Dim> field, room;
  room.room = 4.0;
  Explorer<Dim> outdoors(field, cube<Dim>(5.0), corner<Dim>(), coarse<Dim>());
  run(outdoors);
  EXPECT_TRUE(outdoors.verdict().complete);
  EXPECT_LE(outdoors.steps().size(), 4U);
  Explorer<Dim> indoors(room, cube<Dim>(5.0), Vec<Dim>::Constant(0.3), coarse<Dim>());
  run(indoors);
  EXPECT_TRUE(indoors.verdict().complete) << indoors.verdict().reason;
  EXPECT_GT(indoors.verdict().seen_fraction, 0.99);
}

TYPED_TEST(Explore, SameBitsForAnyNumberOfThreadsAndFromPlayedBackScans) {
  constexpr int Dim = TypeParam::value;
  struct Outcome {
    std::vector<NodeState> states;
    std::vector<float> psi, metric;
    std::vector<double> scores;
    bool operator==(const Outcome&) const = default;
  };
  const auto outcome = [](int threads) {
    const ThreadLimit limit(threads);
    BallWorld<Dim> world = two_balls<Dim>();
    ExploreOptions options = coarse<Dim>();
    options.max_scans = 4;
    Explorer<Dim> explorer(world, cube<Dim>(5.0), corner<Dim>(), options);
    run(explorer);
    Outcome out{explorer.states().values, explorer.psi().values, {}, {}};
    for (const float e : explorer.metric().values) out.metric.push_back(std::isnan(e) ? -1.0F : e);
    for (const auto& record : explorer.steps()) out.scores.push_back(record.next_score);
    return out;
  };
  const Outcome one = outcome(1);
  EXPECT_EQ(one, outcome(2));
  EXPECT_EQ(one, outcome(7));
}

TYPED_TEST(Explore, TheOccludedSetOnlyShrinksButForNewObstacles) {
  constexpr int Dim = TypeParam::value;
  BallWorld<Dim> world = two_balls<Dim>();
  Explorer<Dim> explorer(world, cube<Dim>(5.0), corner<Dim>(), coarse<Dim>());
  explorer.step();
  Field<Dim, NodeState> before = explorer.states();
  while (!explorer.finished()) {
    explorer.step();
    const Field<Dim, NodeState> after = explorer.states();
    for (std::size_t i = 0; i < after.values.size(); ++i)
      if (before[i] == NodeState::seen) {
        ASSERT_NE(after[i], NodeState::unseen);
      }
    before = after;
  }
}

TYPED_TEST(Explore, WrongInputIsRefusedWithAReason) {
  constexpr int Dim = TypeParam::value;
  BallWorld<Dim> world;
  const auto code = [&](const Vec<Dim>& start, const ExploreOptions& options) {
    try {
      Explorer<Dim> explorer(world, cube<Dim>(5.0), start, options);
    } catch (const Error& error) {
      return static_cast<int>(error.code());
    }
    return 0;
  };
  ExploreOptions negative = coarse<Dim>(), fine = coarse<Dim>();
  negative.surface.eta = -0.1;
  fine.voxel = 1e-4;
  EXPECT_EQ(code(corner<Dim>(), coarse<Dim>()), 0);
  EXPECT_EQ(code(Vec<Dim>::Constant(6.0), coarse<Dim>()), static_cast<int>(ErrorCode::bad_input));
  EXPECT_EQ(code(Vec<Dim>::Constant(std::numeric_limits<double>::quiet_NaN()), coarse<Dim>()), static_cast<int>(ErrorCode::bad_input));
  EXPECT_EQ(code(corner<Dim>(), negative), static_cast<int>(ErrorCode::bad_input));
  EXPECT_EQ(code(corner<Dim>(), fine), static_cast<int>(ErrorCode::memory));
}

TYPED_TEST(Explore, GoesWhereItIsTold) {
  constexpr int Dim = TypeParam::value;
  BallWorld<Dim> world = two_balls<Dim>();
  Vec<Dim> start = Vec<Dim>::Zero();
  start[1] = -3.2;
  Explorer<Dim> explorer(world, cube<Dim>(5.0), start, coarse<Dim>());
  EXPECT_THROW(explorer.go_to(start), Error);  // Nothing is known yet.
  explorer.step();
  ASSERT_FALSE(explorer.finished());
  const Grid<Dim>& grid = explorer.window();
  std::size_t farthest = grid.linear(grid.nearest(start));
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (explorer.reachable()[i] != 0 && (grid.position(i) - start).norm() > (grid.position(farthest) - start).norm()) farthest = i;
  const Vec<Dim> place = grid.position(farthest);
  ASSERT_NE(place, explorer.path().back());
  EXPECT_THROW(explorer.go_to(place + Vec<Dim>::Constant(0.1)), Error);  // No node.
  EXPECT_THROW(explorer.go_to(Vec<Dim>::Constant(1000.0)), Error);
  explorer.go_to(place);
  EXPECT_EQ(explorer.path().back(), place);
  const StepRecord<Dim> step = explorer.step();
  EXPECT_EQ(step.vantage, place);
  EXPECT_GE(step.path_length, (place - start).norm() - 1e-9);
  EXPECT_GT(step.new_volume, 0.0);
}

TYPED_TEST(Explore, StopsAtTheLimitWithoutClaimingToBeComplete) {
  constexpr int Dim = TypeParam::value;
  BallWorld<Dim> world = two_balls<Dim>();
  ExploreOptions options = coarse<Dim>();
  options.max_scans = 1;
  Explorer<Dim> explorer(world, cube<Dim>(5.0), corner<Dim>(), options);
  run(explorer);
  EXPECT_EQ(explorer.steps().size(), 1U);
  EXPECT_FALSE(explorer.verdict().complete);
  EXPECT_LT(explorer.verdict().seen_fraction, 1.0);
}

}  // namespace
}  // namespace vantage
