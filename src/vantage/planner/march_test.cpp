// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vantage/base/random.h"
#include "vantage/planner/boundary_metric.h"
#include "vantage/planner/candidates.h"
#include "vantage/planner/march_grid.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class MarchTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MarchTest, Dimensions);

template <int Dim>
Vec<Dim> random_place(Random& random, double half_side) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-half_side, half_side);
  return p;
}

/// Balls of shadow and of obstacle in seen space.
template <int Dim>
HandMade<Dim> balls(std::uint64_t seed, double half_side = 4.0) {
  Random random(seed);
  std::vector<Vec<Dim>> shadows, obstacles;
  for (int k = 0; k < 5; ++k) {
    shadows.push_back(random_place<Dim>(random, half_side));
    obstacles.push_back(random_place<Dim>(random, half_side));
  }
  return HandMade<Dim>(cube<Dim>(half_side), [&](const Vec<Dim>& p) {
    for (const Vec<Dim>& c : obstacles)
      if ((p - c).norm() < 0.6) return NodeState::obstacle;
    for (const Vec<Dim>& c : shadows)
      if ((p - c).norm() < 1.3) return NodeState::unseen;
    return NodeState::seen;
  });
}

TYPED_TEST(MarchTest, ChessboardDistanceEqualsSearch) {
  constexpr int Dim = TypeParam::value;
  const auto belief = balls<Dim>(3, 6.0 - 3.5 * (Dim - 2));
  const Grid<Dim>& window = belief.state.window;
  const MarchGrid<Dim> grid(belief.state);
  for (const NodeState state : {NodeState::seen, NodeState::unseen}) {
    const auto distance = chessboard_distance<Dim>(belief.state, state);
    for (std::size_t i = 0; i < window.size(); ++i) {
      int least = belief.state[i] == state ? MarchGrid<Dim>::kFar : 0;
      for (std::size_t k = 0; k < window.size() && least > 0; ++k)
        if (belief.state[k] != state) least = std::min(least, static_cast<int>((window.local(k) - window.local(i)).cwiseAbs().maxCoeff()));
      ASSERT_EQ(static_cast<int>(distance[i]), least);
      const std::uint8_t code = grid.code(window.local(i));
      ASSERT_EQ(MarchGrid<Dim>::state(code), belief.state[i]);
      ASSERT_TRUE(belief.state[i] != state || MarchGrid<Dim>::distance(code) == least);
    }
  }
}

/// Striding over what is alike changes nothing but the time.
TYPED_TEST(MarchTest, StridesEqualCellByCell) {
  constexpr int Dim = TypeParam::value;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto belief = balls<Dim>(seed);
    const MarchGrid<Dim> grid(belief.state);
    Field<Dim> openness(belief.state.window);
    Random random(seed + 100);
    for (std::size_t i = 0; i < openness.values.size(); ++i)
      if (belief.state[i] == NodeState::unseen && random.uniform() < 0.7) openness[i] = static_cast<float>(random.uniform());
    const RayMarch<Dim> plain(belief.view(), openness, {0.4, 5.0, 0.5}), fast(belief.view(), openness, {0.4, 5.0, 0.5, nullptr, &grid});
    const auto directions = spread_directions<Dim>(200, seed);
    for (int k = 0; k < 40; ++k) {
      const Vec<Dim> z = random_place<Dim>(random, 3.9), y = random_place<Dim>(random, 3.9);
      const RaySums a = plain.look(z, directions), b = fast.look(z, directions);
      EXPECT_NEAR(a.volume, b.volume, 1e-5 * a.volume);
      EXPECT_NEAR(a.area, b.area, 1e-5 * a.area);
      EXPECT_DOUBLE_EQ(a.solid_angle, b.solid_angle);
      EXPECT_EQ(plain.line_of_sight(z, y, 0.3), fast.line_of_sight(z, y, 0.3));
    }
  }
}

/// w = 1 everywhere takes the samples one by one.
TYPED_TEST(MarchTest, SummedFadingEqualsSampleBySample) {
  constexpr int Dim = TypeParam::value;
  const auto belief = balls<Dim>(5);
  const MarchGrid<Dim> grid(belief.state);
  const Field<Dim> openness(belief.state.window, 0.5F), ones(belief.state.window, 1.0F);
  const auto directions = spread_directions<Dim>(300, 1);
  for (const double lambda : {0.0, 0.1, 2.0}) {
    const RayMarch<Dim> summed(belief.view(), openness, {lambda, 6.0, 0.0, nullptr, &grid});
    const RayMarch<Dim> sampled(belief.view(), openness, {lambda, 6.0, 0.0, &ones, &grid});
    const double a = summed.look(on_axis<Dim>(0.3), directions).volume, b = sampled.look(on_axis<Dim>(0.3), directions).volume;
    EXPECT_GT(a, 0.0);
    EXPECT_NEAR(a, b, 1e-5 * b);
  }
}

/// cos(theta) dA = r^(d-1) dOmega: the boundary sum with line of sight and the ray form are the same integral, point by point. Faces stand in the
/// lattice's directions, so the sum takes cos against these; rays sample it with an error of about the boundary's share over the root of their
/// number.
TYPED_TEST(MarchTest, RayFormEqualsBoundarySumPointByPoint) {
  constexpr int Dim = TypeParam::value;
  int compared = 0;
  for (const std::uint64_t seed : {11, 12, 13}) {
    const auto belief = balls<Dim>(seed, 5.0);
    const Grid<Dim>& window = belief.state.window;
    const MarchGrid<Dim> grid(belief.state);
    const Field<Dim> openness(window, 1.0F);
    const RayMarch<Dim> march(belief.view(), openness, {0.0, 100.0, 0.0, nullptr, &grid});
    const auto directions = spread_directions<Dim>(20000, seed);
    Random random(seed);
    for (int k = 0; k < 30; ++k) {
      const Vec<Dim> z = window.position(window.nearest(random_place<Dim>(random, 4.0)));
      if (belief.psi.at(window.nearest(z)) < 0.45) continue;
      double sum = 0.0;
      constexpr int kCut = 16 >> (2 * (Dim - 2));  // Parts of a face along each side, each seen or not.
      Grid<Dim> parts{kTestSpacing / kCut, Index<Dim>::Zero(), Index<Dim>::Constant(kCut)};
      for (std::size_t i = 0; i < window.size(); ++i) {
        if (belief.state[i] != NodeState::seen) continue;
        for (int direction = 0; direction < 2 * Dim; ++direction) {
          const int axis = direction / 2;
          Index<Dim> there = window.local(i);
          there[axis] += direction % 2 == 0 ? 1 : -1;
          if (!window.inside(there) || belief.state.at(there) != NodeState::unseen) continue;
          const Vec<Dim> center = 0.5 * (window.position(i) + window.position(there));
          const double side = direction % 2 == 0 ? -1.0 : 1.0;  // Where the seen node lies.
          if (side * (z - center)[axis] <= 0.0) continue;
          for (std::size_t part = 0; part < parts.size(); ++part) {
            if (parts.local(part)[axis] != 0) continue;
            Vec<Dim> y = center + parts.position(part) - Vec<Dim>::Constant(0.5 * kTestSpacing - 0.5 * parts.spacing);
            y[axis] = center[axis];
            const double distance = (z - y).norm();
            if (!march.line_of_sight(z, y, 1e-4)) continue;
            double area = 1.0;
            for (int a = 1; a < Dim; ++a) area *= parts.spacing;
            sum += area * side * (z - y)[axis] / distance;
          }
        }
      }
      const double rays = march.look(z, directions).area;
      EXPECT_NEAR(rays, sum, 0.02 * sum);
      compared += sum > 0.5;
    }
  }
  EXPECT_GE(compared, 6);
}

}  // namespace
}  // namespace vantage
