// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/lazy_pool.h"

#include <gtest/gtest.h>

#include <tuple>

#include "vantage/base/random.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class LazyPoolTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LazyPoolTest, Dimensions);

/// An unseen place with balls in it, that balls of sight open one after the other.
template <int Dim>
class Opening {
 public:
  explicit Opening(std::uint64_t seed) : belief(cube<Dim>(5.0), [](const Vec<Dim>&) { return NodeState::unseen; }), random_(seed) {
    for (int k = 0; k < 4; ++k) solids_.push_back(place());
  }
  void open() {
    const Vec<Dim> eye = scans_++ == 0 ? Vec<Dim>::Zero().eval() : place();
    for (std::size_t i = 0; i < belief.state.values.size(); ++i) {
      const Vec<Dim> p = belief.state.window.position(i);
      if ((p - eye).norm() > 2.5) continue;
      const bool solid = std::any_of(solids_.begin(), solids_.end(), [&](const Vec<Dim>& c) { return (p - c).norm() < 0.8; });
      belief.state[i] = solid ? NodeState::obstacle : NodeState::seen;
    }
    belief.redistance();
  }
  HandMade<Dim> belief;

 private:
  Vec<Dim> place() {
    Vec<Dim> p;
    for (int a = 0; a < Dim; ++a) p[a] = random_.uniform(-4.0, 4.0);
    return p;
  }
  Random random_;
  int scans_ = 0;
  std::vector<Vec<Dim>> solids_;
};

/// Gains fall from scan to scan, and the best is that of looking at all.
TYPED_TEST(LazyPoolTest, SameBestAsLookingAtAll) {
  constexpr int Dim = TypeParam::value;
  const auto directions = spread_directions<Dim>(150, 1);
  std::size_t looked = 0, all = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Opening<Dim> place(seed);
    const Grid<Dim>& window = place.belief.state.window;
    LazyPool<Dim> lazy(window, 4000);
    MarchGrid<Dim> before;
    std::vector<Vec<Dim>> visited;
    std::vector<double> last(window.size(), kInfinity);
    for (int scan = 0; scan < 8; ++scan) {
      place.open();
      const MarchGrid<Dim> grid(place.belief.state);
      EXPECT_EQ(grid.grown_from(before), scan > 0);
      before = grid;
      Field<Dim, std::uint8_t> reachable(window);
      std::vector<std::size_t> nodes;
      for (std::size_t i = 0; i < window.size(); ++i) {
        reachable[i] = place.belief.state[i] == NodeState::seen && (place.belief.known_distance[i] > 0.4F);
        if (reachable[i] != 0 && i % 7 == 0) nodes.push_back(i);
      }
      const Field<Dim> openness(window);
      const RayMarch<Dim> rays(place.belief.view(), openness, {0.3, 4.0, 0.0, nullptr, &grid});
      lazy.offer(nodes);
      LazyPool<Dim> eager = lazy;
      eager.forget();
      const auto quick = lazy.best(rays, directions, reachable, visited), slow = eager.best(rays, directions, reachable, visited);
      ASSERT_FALSE(quick.empty());
      EXPECT_EQ(quick[0].node, slow[0].node);
      EXPECT_EQ(quick[0].volume, slow[0].volume);
      EXPECT_GE(slow.size(), quick.size());
      for (const auto& gain : slow) {
        EXPECT_LE(gain.volume, last[gain.node] * (1.0 + 1e-12));
        last[gain.node] = gain.volume;
      }
      looked += quick.size();
      all += slow.size();
      visited.push_back(window.position(quick[0].node));
    }
  }
  EXPECT_LT(looked, all * 9 / 10);
}

TYPED_TEST(LazyPoolTest, VolumeOfAnUnseenBallIsThatOfTheBall) {
  constexpr int Dim = TypeParam::value;
  const HandMade<Dim> belief(cube<Dim>(5.0), [](const Vec<Dim>& p) { return p.norm() < 1.0 ? NodeState::seen : NodeState::unseen; });
  const MarchGrid<Dim> grid(belief.state);
  const Field<Dim> openness(belief.state.window);
  const double range = 4.0, unit = 2.0 * kPi * (Dim - 1) / Dim;
  const auto ball = [&](double r) { return unit * std::pow(r, Dim); };
  for (const MarchGrid<Dim>* of : {&grid, static_cast<const MarchGrid<Dim>*>(nullptr)}) {
    const RayMarch<Dim> rays(belief.view(), openness, {0.5, range, 0.0, nullptr, of});
    const double volume = rays.unseen_volume(Vec<Dim>::Zero(), spread_directions<Dim>(1000, 1));
    EXPECT_NEAR(volume, ball(range) - ball(1.0), 0.05 * volume);
  }
}

}  // namespace
}  // namespace vantage
