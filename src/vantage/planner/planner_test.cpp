// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/planner.h"

#include <gtest/gtest.h>

#include <map>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/planner/boundary_metric.h"
#include "vantage/planner/candidates.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class PlannerTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PlannerTest, Dimensions);

constexpr double kH = kTestSpacing;

/// Seen for x < 0, unseen beyond: one wall of shadow boundary.
template <int Dim>
HandMade<Dim> half_space(double half_side) {
  return HandMade<Dim>(cube<Dim>(half_side), [](const Vec<Dim>& p) { return p[0] < 0.0 ? NodeState::seen : NodeState::unseen; });
}

template <int Dim>
Field<Dim> openness_one(const HandMade<Dim>& belief) {
  return Field<Dim>(belief.state.window, 1.0F);
}

/// Closed forms for a plane at distance D within range R (2D: a line): area integral of cos over the disc, and the cap behind it.
struct OneWall {
  double area, cap, angle;
};
template <int Dim>
OneWall one_wall(double d, double r);
template <>
OneWall one_wall<2>(double d, double r) {
  const double theta = std::acos(d / r);
  return {2.0 * d * std::log(1.0 / std::cos(theta) + std::tan(theta)), r * r * theta - d * std::sqrt(r * r - d * d), 2.0 * theta};
}
template <>
OneWall one_wall<3>(double d, double r) {
  return {2.0 * kPi * d * (r - d), kPi / 3.0 * (r - d) * (r - d) * (2.0 * r + d), 2.0 * kPi * (1.0 - d / r)};
}

TYPED_TEST(PlannerTest, DirectionsAreEven) {
  constexpr int Dim = TypeParam::value;
  const auto all = spread_directions<Dim>(1000, 7);
  Vec<Dim> mean = Vec<Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim> second = Eigen::Matrix<double, Dim, Dim>::Zero();
  for (const Vec<Dim>& d : all) {
    ASSERT_NEAR(d.norm(), 1.0, 1e-12);
    mean += d / 1000.0;
    second += d * d.transpose() / 1000.0;
  }
  EXPECT_LT(mean.norm(), 0.01);
  EXPECT_LT((second - Eigen::Matrix<double, Dim, Dim>::Identity() / Dim).norm(), 0.01);
  EXPECT_NE(spread_directions<Dim>(1000, 8)[0], all[0]);
}

TYPED_TEST(PlannerTest, RayFormOfOneWall) {
  constexpr int Dim = TypeParam::value;
  const auto belief = half_space<Dim>(6.0);
  const auto openness = openness_one(belief);
  const double wall = -0.5 * kH;  // The face between the last seen node and the first unseen.
  const double d = 2.0, r = 5.0;
  const RayMarch<Dim> march(belief.view(), openness, {0.0, r, 0.0});
  const RaySums sums = march.look(on_axis<Dim>(wall - d), spread_directions<Dim>(4000, 1));
  const OneWall truth = one_wall<Dim>(d, r);
  EXPECT_NEAR(sums.solid_angle, truth.angle, 0.01 * truth.angle);
  EXPECT_NEAR(sums.area, truth.area, 0.01 * truth.area);
  EXPECT_NEAR(sums.volume, truth.cap, 0.01 * truth.cap);
}

TYPED_TEST(PlannerTest, BoundarySumOfOneWallAgreesWithTheRayForm) {
  constexpr int Dim = TypeParam::value;
  const auto belief = half_space<Dim>(6.0);
  const double d = 2.0, r = 5.0;
  OpeningModel<Dim> opening(OpeningModel<Dim>::Rule::masks);
  const Vec<Dim> z = on_axis<Dim>(-0.5 * kH - d);
  opening.update(belief.view(), on_axis<Dim>(-5.9), 0.1);  // An observer too near-sighted to have looked.
  const RayMarch<Dim> march(belief.view(), opening.openness(), {0.0, r, 0.0});
  PlannerOptions options;
  std::vector<BoundaryElement<Dim>> near;
  for (const auto& element : boundary_elements<Dim>(belief.view(), opening.faces(), options))
    if ((element.place - z).norm() <= r) near.push_back(element);
  const double faces = boundary_metric<Dim>(near, march, z, options);
  EXPECT_NEAR(faces, one_wall<Dim>(d, r).area, 0.05 * one_wall<Dim>(d, r).area);

  options.elements = PlannerOptions::Elements::smeared;
  near.clear();
  for (const auto& element : boundary_elements<Dim>(belief.view(), opening.faces(), options))
    if ((element.place - z).norm() <= r) near.push_back(element);
  options.line_of_sight = false;
  EXPECT_NEAR(boundary_metric<Dim>(near, march, z, options), one_wall<Dim>(d, r).area, 0.1 * one_wall<Dim>(d, r).area);
  // As printed, places on the seen side count nothing, and the delta counts too much.
  options.facing = PlannerOptions::Facing::behind;
  EXPECT_EQ(boundary_metric<Dim>(near, march, z, options), 0.0);
  EXPECT_GT(boundary_metric<Dim>(near, march, on_axis<Dim>(d), options), 0.0);
}

TYPED_TEST(PlannerTest, OpacityFadesTheUnseenAndObstaclesEndTheRay) {
  constexpr int Dim = TypeParam::value;
  const auto open = half_space<Dim>(6.0);
  const HandMade<Dim> walled(cube<Dim>(6.0), [](const Vec<Dim>& p) {
    return p[0] < 0.0 ? NodeState::seen : p[0] < 2.0 ? NodeState::unseen : NodeState::obstacle;
  });
  const auto openness = openness_one(open);
  const auto rays = spread_directions<Dim>(1000, 1);
  const auto volume = [&](const HandMade<Dim>& belief, double lambda) {
    return RayMarch<Dim>(belief.view(), openness, {lambda, 5.0, 0.0}).look(on_axis<Dim>(-1.0), rays).volume;
  };
  EXPECT_LT(volume(open, 0.5), 0.7 * volume(open, 0.0));
  EXPECT_LT(volume(walled, 0.0), 0.7 * volume(open, 0.0));
  EXPECT_GT(volume(walled, 0.0), 0.0);
}

/// Oracle: samples a hundredth of a cell apart.
TYPED_TEST(PlannerTest, LineOfSightEqualsDenseSampling) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  std::vector<Vec<Dim>> centers;
  const auto place = [&] {
    Vec<Dim> p;
    for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-3.9, 3.9);
    return p;
  };
  for (int k = 0; k < 6; ++k) centers.push_back(place());
  const HandMade<Dim> belief(cube<Dim>(4.0), [&](const Vec<Dim>& p) {
    for (const Vec<Dim>& c : centers)
      if ((p - c).norm() < 1.2) return NodeState::unseen;
    return NodeState::seen;
  });
  const auto openness = openness_one(belief);
  const RayMarch<Dim> march(belief.view(), openness, {0.0, 100.0, 0.0});
  int blocked = 0, disagree = 0;
  for (int k = 0; k < 400; ++k) {
    const Vec<Dim> a = place(), b = place();
    if (belief.state.at(belief.state.window.nearest(a)) != NodeState::seen) continue;
    bool clear = true;
    const double own = std::sqrt(double{Dim}) * kH, length = (b - a).norm();
    for (double t = own; t < length - 0.5; t += 0.01 * kH)
      clear = clear && belief.state.at(belief.state.window.nearest(a + (b - a) * (t / length))) == NodeState::seen;
    blocked += !clear;
    disagree += clear != march.line_of_sight(a, b, 0.5);
    if (clear) {
      EXPECT_TRUE(march.line_of_sight(a, b, 0.5));  // Never blind where the dense march sees.
    }
  }
  EXPECT_GT(blocked, 20);
  EXPECT_LE(disagree, 4);  // Corners of less than half a cell.
}

/// Two rooms joined by a door of the given width in the wall x = 0.
template <int Dim>
HandMade<Dim> two_rooms(double door) {
  return HandMade<Dim>(cube<Dim>(4.0), [=](const Vec<Dim>& p) {
    const bool wall = std::abs(p[0]) < 0.2 && std::abs(p[1]) >= 0.5 * door;
    return wall ? NodeState::obstacle : NodeState::seen;
  });
}

TYPED_TEST(PlannerTest, ClearanceClosesNarrowDoors) {
  constexpr int Dim = TypeParam::value;
  const auto far_side = [](const HandMade<Dim>& belief, double clearance) {
    const auto reached = reachable_nodes<Dim>(belief.view(), on_axis<Dim>(-3.0), clearance);
    return reached.at(reached.window.nearest(on_axis<Dim>(3.0))) != 0;
  };
  EXPECT_TRUE(far_side(two_rooms<Dim>(2.0), 0.5));
  EXPECT_FALSE(far_side(two_rooms<Dim>(2.0), 1.3));
  EXPECT_FALSE(far_side(two_rooms<Dim>(0.0), 0.0));
}

/// Beside a thin wall at x = 0.12 the nearest free node is behind it; none in between, the nearest will do.
TYPED_TEST(PlannerTest, AWayBeginsOnOurSideOfAWall) {
  constexpr int Dim = TypeParam::value;
  HandMade<Dim> belief(cube<Dim>(2.0), [](const Vec<Dim>&) { return NodeState::seen; });
  const Grid<Dim>& grid = belief.state.window;
  const Vec<Dim> from = on_axis<Dim>(0.1);
  const auto beside = [&](std::size_t node) { return grid.nearest(grid.position(node)) != grid.nearest(from); };
  EXPECT_EQ(grid.position(first_node<Dim>(belief.view(), from, beside)), on_axis<Dim>(0.25));
  for (std::size_t i = 0; i < grid.size(); ++i) belief.known_distance[i] = static_cast<float>(std::abs(grid.position(i)[0] - 0.12));
  EXPECT_LT(grid.position(first_node<Dim>(belief.view(), from, beside))[0], 0.12);
  const auto behind = [&](std::size_t node) { return grid.position(node)[0] > 0.12; };
  EXPECT_EQ(grid.position(first_node<Dim>(belief.view(), from, behind)), on_axis<Dim>(0.25));
  EXPECT_EQ(first_node<Dim>(belief.view(), from, [](std::size_t) { return false; }), kNoNode);
}

TYPED_TEST(PlannerTest, MedialNodesOfACorridorLieOnItsMidline) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> corridor(cube<Dim>(4.0), [](const Vec<Dim>& p) { return std::abs(p[1]) < 1.6 ? NodeState::seen : NodeState::obstacle; });
  const Vec<Dim> home = on_axis<Dim>(0.0);
  const auto reached = reachable_nodes<Dim>(corridor.view(), home, 0.5);
  const auto nodes = medial_nodes<Dim>(corridor.view(), reached, std::span(&home, 1), PlannerOptions{});
  ASSERT_FALSE(nodes.empty());
  for (const std::size_t node : nodes) {
    EXPECT_LE(std::abs(reached.window.position(node)[1]), 1.01 * kH);
    EXPECT_GE((reached.window.position(node) - home).norm(), 2.0 * kH);
  }
}

TYPED_TEST(PlannerTest, CandidatesAreDistinctFewAndAimed) {
  constexpr int Dim = TypeParam::value;
  const auto belief = half_space<Dim>(6.0);
  OpeningModel<Dim> opening(OpeningModel<Dim>::Rule::learned);
  opening.update(belief.view(), on_axis<Dim>(-5.0), 80.0);
  const RayMarch<Dim> march(belief.view(), opening.openness(), {0.0, 80.0, 0.0});
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < belief.state.values.size(); ++i)
    if (belief.state[i] == NodeState::seen) seen.push_back(i);
  const auto chosen = choose_candidates<Dim>(seen, opening.faces(), march, belief.state.window, 100, 3);
  EXPECT_LE(chosen.size(), 101U);
  EXPECT_GE(chosen.size(), 60U);
  EXPECT_TRUE(std::adjacent_find(chosen.begin(), chosen.end(), std::greater_equal<>()) == chosen.end());
  EXPECT_EQ(choose_candidates<Dim>(seen, opening.faces(), march, belief.state.window, 100, 3), chosen);
}

/// Faces that were looked at and stayed lose their credit; those of the same kind that open gain.
TYPED_TEST(PlannerTest, OpeningProbabilityIsLearned) {
  constexpr int Dim = TypeParam::value;
  const auto shut = half_space<Dim>(4.0);
  OpeningModel<Dim> stubborn(OpeningModel<Dim>::Rule::learned), yielding(OpeningModel<Dim>::Rule::learned);
  const auto mean = [](const OpeningModel<Dim>& model) {
    double sum = 0.0;
    for (const auto& face : model.faces()) sum += face.probability / static_cast<double>(model.faces().size());
    return sum;
  };
  stubborn.update(shut.view(), on_axis<Dim>(-3.0), 80.0);
  const double first = mean(stubborn);
  for (int k = 0; k < 3; ++k) stubborn.update(shut.view(), on_axis<Dim>(-3.0), 80.0);
  EXPECT_LT(mean(stubborn), 0.3 * first);
  for (double x = 0.0; x < 3.0; x += 1.0) {
    const HandMade<Dim> belief(cube<Dim>(4.0), [x](const Vec<Dim>& p) { return p[0] < x ? NodeState::seen : NodeState::unseen; });
    yielding.update(belief.view(), on_axis<Dim>(-3.0), 80.0);
  }
  EXPECT_GT(mean(yielding), first);
}

TYPED_TEST(PlannerTest, AClosedBoxIsCompleteAndNamesWhatIsEnclosed) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> box(cube<Dim>(4.0), [](const Vec<Dim>& p) {
    const double r = p.template lpNorm<Eigen::Infinity>();
    return r < 2.0 ? NodeState::seen : r < 2.6 ? NodeState::obstacle : NodeState::unseen;
  });
  Planner<Dim> planner(PlannerOptions{}, 80.0, 1);
  const Decision<Dim> decision = planner.choose(box.view(), on_axis<Dim>(0.1), 1.0);
  EXPECT_FALSE(decision.found);
  EXPECT_EQ(decision.end, Decision<Dim>::End::nothing_can_open);
  const Verdict<Dim> verdict = planner.assess(box.view());
  EXPECT_DOUBLE_EQ(verdict.seen_fraction, 1.0);
  ASSERT_FALSE(verdict.unseen.empty());
  EXPECT_EQ(verdict.unseen[0].reason, "enclosed");
}

/// Beyond a gulf the scanner cannot cross, and farther than it sees.
TYPED_TEST(PlannerTest, RegionsBeyondRangeOrReachAreNamedSo) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> belief(cube<Dim>(8.0), [](const Vec<Dim>& p) {
    if (std::abs(p[0]) < 0.3) return NodeState::obstacle;
    return p[0] < 5.0 ? NodeState::seen : NodeState::unseen;
  });
  OpeningModel<Dim> opening(OpeningModel<Dim>::Rule::learned);
  opening.update(belief.view(), on_axis<Dim>(-4.0), 80.0);
  const auto reached = reachable_nodes<Dim>(belief.view(), on_axis<Dim>(-4.0), 0.3);
  const auto reason = [&](double range) {
    const Verdict<Dim> verdict = assess<Dim>(belief.view(), opening.faces(), reached, {.opacity = 0.1, .max_range = range});
    return verdict.unseen.at(0).reason;
  };
  EXPECT_EQ(reason(80.0), "no reachable view");
  EXPECT_EQ(reason(3.0), "beyond range");
}

TYPED_TEST(PlannerTest, GoesToTheDoorByASafePath) {
  constexpr int Dim = TypeParam::value;
  // The second room is unseen but for what shows through the door.
  const HandMade<Dim> belief(cube<Dim>(6.0), [](const Vec<Dim>& p) {
    if (std::abs(p[0]) < 0.2 && std::abs(p[1]) > 1.0) return NodeState::obstacle;
    return p[0] < 0.3 ? NodeState::seen : NodeState::unseen;
  });
  Planner<Dim> planner(PlannerOptions{}, 80.0, 1);
  Vec<Dim> here = Vec<Dim>::Constant(-3.0);
  const Decision<Dim> decision = planner.choose(belief.view(), here, 1.0);
  ASSERT_TRUE(decision.found);
  EXPECT_GT(decision.expected_volume, 1.0);
  EXPECT_LT(std::abs(decision.position[1]), 2.5);
  ASSERT_GE(decision.path.size(), 2U);
  EXPECT_LT((decision.path.back() - decision.position).norm(), 1e-9);
  for (std::size_t i = 1; i < decision.path.size(); ++i)
    for (double t = 0.0; t <= 1.0; t += 0.05) {
      const Vec<Dim> p = decision.path[i - 1] + t * (decision.path[i] - decision.path[i - 1]);
      EXPECT_EQ(belief.state.at(belief.state.window.nearest(p)), NodeState::seen);
    }
  const Verdict<Dim> verdict = planner.assess(belief.view());
  EXPECT_LT(verdict.seen_low, verdict.seen_fraction + 1e-12);
  EXPECT_LE(verdict.seen_fraction, verdict.seen_high);
  EXPECT_LT(verdict.seen_fraction, 1.0);
}

/// The weighting w: a place of weight 0 draws nobody, and the terms scale with it.
TYPED_TEST(PlannerTest, WeightsDirectTheMetric) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> belief(cube<Dim>(6.0), [](const Vec<Dim>& p) { return std::abs(p[0]) < 2.0 ? NodeState::seen : NodeState::unseen; });
  const auto choose = [&](double left, double right) {
    PlannerOptions options;
    for (const double x : {-6.0, 0.0}) {
      for (int a = 0; a < Dim; ++a) options.weights.push_back(a == 0 ? x : -6.0);
      for (int a = 0; a < Dim; ++a) options.weights.push_back(a == 0 ? x + 6.0 : 6.0);
      options.weights.push_back(x < 0.0 ? left : right);
    }
    Planner<Dim> planner(options, 80.0, 1);
    return planner.choose(belief.view(), on_axis<Dim>(0.0), 1.0);
  };
  const double both = choose(1.0, 1.0).expected_volume, doubled = choose(2.0, 2.0).expected_volume;
  EXPECT_NEAR(doubled, 2.0 * both, 1e-3 * both);
  EXPECT_LT(choose(0.0, 1.0).expected_volume, 0.9 * both);
  EXPECT_FALSE(choose(0.0, 0.0).found);
  PlannerOptions short_list;
  short_list.weights = {0.0, 1.0};
  EXPECT_ANY_THROW(Planner<Dim>(short_list, 80.0, 1));
}

/// A corridor along the first axis, unseen at its ends: 2 m on the left, 4 m on the right.
template <int Dim>
HandMade<Dim> corridor() {
  return HandMade<Dim>(cube<Dim>(8.0), [](const Vec<Dim>& p) {
    for (int a = 1; a < Dim; ++a)
      if (std::abs(p[a]) > 1.5) return NodeState::obstacle;
    return p[0] < -6.0 || p[0] > 4.0 ? NodeState::unseen : NodeState::seen;
  });
}

TYPED_TEST(PlannerTest, TheWayThereCountsAsAsked) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> belief = corridor<Dim>();
  const Vec<Dim> here = on_axis<Dim>(-2.0);
  const auto choose = [&](double weight) {
    PlannerOptions options;
    options.lambda_factor = 0.0;
    options.refine = options.candidates;  // All are looked at alike, so that only the way there makes a difference.
    options.travel_weight = weight;
    options.speed = 0.5;
    options.scan_time = 4.0;
    return Planner<Dim>(options, 80.0, 1).choose(belief.view(), here, 1.0);
  };
  const Decision<Dim> free = choose(0.0), once = choose(1.0);
  std::map<std::size_t, float> scores(free.scored.begin(), free.scored.end());
  ASSERT_EQ(scores.size(), once.scored.size());
  for (const auto& [node, score] : once.scored) {
    const double walk = (belief.state.window.position(node) - here).norm();
    EXPECT_NEAR(score, static_cast<double>(scores.at(node)) / (1.0 + walk / 2.0), 0.1 * score);  // First-order marching.
  }
  EXPECT_GT(free.position[0], here[0]);
  EXPECT_LT((choose(4.0).position - here).norm(), (free.position - here).norm());
  PlannerOptions optimistic;
  optimistic.metric = PlannerOptions::Metric::optimistic;
  optimistic.travel_weight = 1.0;
  EXPECT_ANY_THROW(Planner<Dim>(optimistic, 80.0, 1));
}

/// The pair that begins with the chosen place shows no less than the one that begins with the best place.
TYPED_TEST(PlannerTest, LookingAheadFindsTheBetterPair) {
  constexpr int Dim = TypeParam::value;
  // A hall with niches on both sides, two of which a place in the middle sees in part.
  const HandMade<Dim> belief(cube<Dim>(6.0), [](const Vec<Dim>& p) {
    if (std::abs(p[1]) < 2.0) return NodeState::seen;
    const bool niche = std::abs(std::abs(p[0]) - 2.0) < 1.0 || std::abs(p[0]) > 5.0;
    return niche ? NodeState::unseen : NodeState::obstacle;
  });
  PlannerOptions options;
  options.solid_angle_weight = 0.0;
  options.candidates = 30;
  const auto pair = [&](std::int64_t look_ahead) {
    options.look_ahead = look_ahead;
    Planner<Dim> planner(options, 80.0, 1);
    const Decision<Dim> decision = planner.choose(belief.view(), on_axis<Dim>(-1.0), 1.0);
    const auto first = planner.rank(belief.view(), {.count = 1, .among = {decision.position}});
    const auto second = planner.rank(belief.view(), {.count = 1, .planned = {decision.position}});
    return first.at(0).new_volume + second.at(0).added_volume;
  };
  EXPECT_GE(pair(1000), pair(0) * (1.0 - 1e-6));
  EXPECT_DOUBLE_EQ(pair(1), pair(0));
}

TYPED_TEST(PlannerTest, SameBitsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto belief = half_space<Dim>(4.0);
  std::vector<std::vector<std::pair<std::size_t, float>>> results;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    Planner<Dim> planner(PlannerOptions{}, 80.0, 1);
    results.push_back(planner.choose(belief.view(), on_axis<Dim>(-3.0), 1.0).scored);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(PlannerOptionsTest, RangesAreChecked) {
  PlannerOptions options;
  options.lambda_factor = -1.0;
  EXPECT_ANY_THROW(Planner<2>(options, 80.0, 1));
  options.lambda_factor = std::numeric_limits<double>::quiet_NaN();
  EXPECT_ANY_THROW(Planner<2>(options, 80.0, 1));
}

}  // namespace
}  // namespace vantage
