// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/baselines.h"

#include <gtest/gtest.h>

#include "vantage/planner/candidates.h"
#include "vantage/planner/planner.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

using Metric = PlannerOptions::Metric;

template <class T>
class BaselineTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BaselineTest, Dimensions);

/// A hall with a niche of shadow at x < -5, small, and a wide one at x > 3; the scanner stands nearer to the small one.
template <int Dim>
HandMade<Dim> hall() {
  return HandMade<Dim>(cube<Dim>(6.0), [](const Vec<Dim>& p) {
    if (p[0] < -5.0 && std::abs(p[1]) < 1.0) return NodeState::unseen;
    return p[0] > 3.0 ? NodeState::unseen : NodeState::seen;
  });
}

template <int Dim>
Decision<Dim> decide(const HandMade<Dim>& belief, Metric metric, std::uint64_t seed = 1) {
  PlannerOptions options;
  options.metric = metric;
  return Planner<Dim>(options, 80.0, seed).choose(belief.view(), on_axis<Dim>(-2.0), 1.0);
}

TYPED_TEST(BaselineTest, NearestGoesToTheNearNicheAndCountToTheWideFront) {
  constexpr int Dim = TypeParam::value;
  const auto belief = hall<Dim>();
  const Decision<Dim> nearest = decide<Dim>(belief, Metric::nearest), count = decide<Dim>(belief, Metric::count);
  ASSERT_TRUE(nearest.found);
  EXPECT_LT(nearest.position[0], -3.5);
  EXPECT_NEAR(1.0 / nearest.score - kTestSpacing, (nearest.position - on_axis<Dim>(-2.0)).norm(), 0.5);  // A straight way.
  ASSERT_TRUE(count.found);
  OpeningModel<Dim> opening(OpeningModel<Dim>::Rule::learned);
  opening.update(belief.view(), on_axis<Dim>(-2.0), 80.0);
  const auto frontier = frontier_faces<Dim>(belief.view(), opening.faces());
  const RayMarch<Dim> march(belief.view(), opening.openness(), {0.0, 80.0, 0.0});
  EXPECT_EQ(count.score, frontier_count<Dim>(frontier, march, count.position, 80.0));
  EXPECT_GE(count.score, 0.5 * static_cast<double>(frontier.size()));
  for (const auto& [node, score] : count.scored) EXPECT_LE(static_cast<double>(score), count.score);
  EXPECT_EQ(frontier_count<Dim>(frontier, march, on_axis<Dim>(-2.0), 0.5), 0.0);
}

TYPED_TEST(BaselineTest, FrontierLeavesOutSpecksAndKnownSurface) {
  constexpr int Dim = TypeParam::value;
  HandMade<Dim> belief(cube<Dim>(4.0), [](const Vec<Dim>& p) { return p[0] > 2.0 ? NodeState::unseen : NodeState::seen; });
  OpeningModel<Dim> opening(OpeningModel<Dim>::Rule::learned);
  opening.update(belief.view(), on_axis<Dim>(-3.0), 0.1);
  std::vector<BoundaryFace<Dim>> faces(opening.faces().begin(), opening.faces().end());
  ASSERT_GT(faces.size(), 10U);
  for (std::size_t i = 1; i < faces.size(); ++i) faces[i].probability = 0.01;
  EXPECT_EQ(frontier_faces<Dim>(belief.view(), faces).size(), 1U);  // A speck, but nothing else.
  BoundaryFace<Dim> speck = faces[0];
  speck.unseen = 0;
  for (auto& face : faces) face.probability = 0.5;
  faces.push_back(speck);
  EXPECT_EQ(frontier_faces<Dim>(belief.view(), faces).size(), faces.size() - 1);
  for (auto& face : faces) face.probability = 0.02;  // All of little credit: they count all the same.
  EXPECT_EQ(frontier_faces<Dim>(belief.view(), faces).size(), faces.size() - 1);
  for (auto& face : faces) face.probability = 0.0;
  EXPECT_TRUE(frontier_faces<Dim>(belief.view(), faces).empty());
}

TYPED_TEST(BaselineTest, RandomGoesAnywhereBySeed) {
  constexpr int Dim = TypeParam::value;
  const auto belief = hall<Dim>();
  const Vec<Dim> home = on_axis<Dim>(-2.0);
  const auto reached = reachable_nodes<Dim>(belief.view(), home, 0.5);
  const auto medial = medial_nodes<Dim>(belief.view(), reached, std::span(&home, 1), PlannerOptions{});
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Decision<Dim> decision = decide<Dim>(belief, Metric::random, seed);
    ASSERT_TRUE(decision.found);
    EXPECT_TRUE(std::binary_search(medial.begin(), medial.end(), belief.state.window.linear(belief.state.window.nearest(decision.position))));
    different += decision.position != decide<Dim>(belief, Metric::random, 99).position;
  }
  EXPECT_GE(different, 6);
}

TYPED_TEST(BaselineTest, SameSeedSamePlace) {
  constexpr int Dim = TypeParam::value;
  const auto belief = hall<Dim>();
  for (const Metric metric : {Metric::nearest, Metric::count, Metric::random, Metric::optimistic}) {
    const Decision<Dim> a = decide<Dim>(belief, metric, 5), b = decide<Dim>(belief, metric, 5);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.scored, b.scored);
    EXPECT_EQ(a.expected_volume, b.expected_volume);
    EXPECT_GT(a.expected_volume, 0.0);
  }
}

TYPED_TEST(BaselineTest, NothingToOpenEndsTheRun) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> box(cube<Dim>(4.0), [](const Vec<Dim>& p) {
    const double r = p.template lpNorm<Eigen::Infinity>();
    return r < 2.0 ? NodeState::seen : r < 2.6 ? NodeState::obstacle : NodeState::unseen;
  });
  for (const Metric metric : {Metric::nearest, Metric::count, Metric::random, Metric::optimistic}) {
    PlannerOptions options;
    options.metric = metric;
    const Decision<Dim> decision = Planner<Dim>(options, 80.0, 1).choose(box.view(), on_axis<Dim>(0.1), 1.0);
    EXPECT_FALSE(decision.found);
    EXPECT_EQ(decision.end, Decision<Dim>::End::nothing_can_open);
  }
}

}  // namespace
}  // namespace vantage
