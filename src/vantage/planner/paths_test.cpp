// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/field/fast_marching.h"
#include "vantage/planner/regions.h"
#include "vantage/planner/safe_path.h"
#include "vantage/planner/test_belief.h"

namespace vantage {
namespace {

template <class T>
class PathsTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PathsTest, Dimensions);

template <int Dim>
Field<Dim, std::uint8_t> random_set(std::uint64_t seed, double share, int side) {
  Field<Dim, std::uint8_t> set(Grid<Dim>{1.0, Index<Dim>::Constant(-3), Index<Dim>::Constant(side)});
  Random random(seed);
  for (std::uint8_t& value : set.values) value = random.uniform() < share;
  return set;
}

template <int Dim>
Regions<Dim> regions_of(const Field<Dim, std::uint8_t>& set) {
  return Regions<Dim>(set.window, [&](std::size_t first, std::span<std::uint8_t> row) {
    std::copy_n(set.values.begin() + static_cast<std::ptrdiff_t>(first), row.size(), row.begin());
  });
}

/// Oracle: a flood from every node that has no label yet.
TYPED_TEST(PathsTest, RegionsEqualFloods) {
  constexpr int Dim = TypeParam::value;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const auto set = random_set<Dim>(seed, 0.15 * static_cast<double>(seed), 40 - 26 * (Dim - 2));
    const Grid<Dim>& grid = set.window;
    const Regions<Dim> regions = regions_of(set);
    Field<Dim, std::int32_t> label(grid, -1);
    std::int32_t count = 0;
    for (std::size_t first = 0; first < grid.size(); ++first) {
      if (set[first] == 0 || label[first] >= 0) continue;
      std::vector<std::size_t> front{first};
      label[first] = count;
      while (!front.empty()) {
        const std::size_t node = front.back();
        front.pop_back();
        for (int direction = 0; direction < 2 * Dim; ++direction) {
          Index<Dim> next = grid.local(node);
          next[direction / 2] += direction % 2 == 0 ? 1 : -1;
          if (!grid.inside(next) || set.at(next) == 0 || label.at(next) >= 0) continue;
          label.at(next) = count;
          front.push_back(grid.linear(next));
        }
      }
      ++count;
    }
    EXPECT_EQ(regions.count(), static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < grid.size(); ++i) ASSERT_EQ(regions.region_of(i), label[i]);
  }
}

/// Oracle: the fast-marching distance. Every sample of the path lies in a reachable node's cell.
TYPED_TEST(PathsTest, PathsAreSafeAndNearlyShortest) {
  constexpr int Dim = TypeParam::value;
  int bent = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const HandMade<Dim> belief(cube<Dim>(5.0), [&](const Vec<Dim>& p) {
      for (int wall = 0; wall < 3; ++wall) {  // With a gap each, somewhere.
        const double gap = 3.0 * Random(seed, static_cast<std::uint64_t>(wall)).uniform(-1.0, 1.0);
        if (std::abs(p[0] - 2.5 * (wall - 1)) < 0.3 && std::abs(p[1] - gap) > 0.6) return NodeState::obstacle;
      }
      return NodeState::seen;
    });
    Field<Dim, std::uint8_t> reachable(belief.state.window);
    for (std::size_t i = 0; i < reachable.values.size(); ++i) reachable[i] = belief.state[i] == NodeState::seen;
    const Vec<Dim> here = on_axis<Dim>(-4.0), goal = on_axis<Dim>(4.0);
    const std::size_t target = reachable.window.linear(reachable.window.nearest(goal));
    const auto path = safe_path<Dim>(reachable, reachable.window.linear(reachable.window.nearest(here)), target, here);
    ASSERT_GE(path.size(), 2U);
    EXPECT_EQ(path.front(), here);
    EXPECT_LT((path.back() - goal).norm(), 1e-9);
    double length = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i) {
      length += (path[i] - path[i - 1]).norm();
      for (double t = 0.0; t <= 1.0; t += 0.01) EXPECT_NE(reachable.at(reachable.window.nearest(path[i - 1] + t * (path[i] - path[i - 1]))), 0);
    }
    const Seed seed_node{target, 0.0F};
    const auto arrival = fast_march<Dim>(reachable, std::span(&seed_node, 1));
    const double shortest = static_cast<double>(arrival.at(arrival.window.nearest(here)));
    EXPECT_LE(length, 1.06 * shortest + kTestSpacing);
    EXPECT_GE(length, 0.9 * shortest);
    bent += path.size() > 3;
  }
  EXPECT_GE(bent, 6);
}

/// Among scattered holes: not even a corner of a cell that may not be stood in is cut.
TYPED_TEST(PathsTest, PathsCutNoCorners) {
  constexpr int Dim = TypeParam::value;
  std::size_t pieces = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    Field<Dim, std::uint8_t> reachable(Grid<Dim>{1.0, Index<Dim>::Zero(), Index<Dim>::Constant(Dim == 2 ? 60 : 24)});
    for (std::size_t i = 0; i < reachable.values.size(); ++i) reachable[i] = random.uniform(0.0, 1.0) < 0.97;
    const std::size_t last = reachable.window.size() - 1;
    reachable[0] = reachable[last] = 1;
    const auto path = safe_path<Dim>(reachable, 0, last, Vec<Dim>::Zero());
    for (std::size_t i = 1; i < path.size(); ++i, ++pieces) {
      const Vec<Dim> way = path[i] - path[i - 1];
      const auto samples = static_cast<int>(way.norm() * 500.0);
      for (int k = 0; k <= samples; ++k)
        ASSERT_NE(reachable.at(reachable.window.nearest(path[i - 1] + way * (static_cast<double>(k) / std::max(1, samples)))), 0) << seed;
    }
  }
  EXPECT_GT(pieces, 60U);
}

TYPED_TEST(PathsTest, NoWayNoPath) {
  constexpr int Dim = TypeParam::value;
  Field<Dim, std::uint8_t> reachable(Grid<Dim>{1.0, Index<Dim>::Zero(), Index<Dim>::Constant(9)}, 1);
  for (std::size_t i = 0; i < reachable.values.size(); ++i) reachable[i] = reachable.window.local(i)[1] != 4;
  const auto path = safe_path<Dim>(reachable, 0, reachable.window.size() - 1, Vec<Dim>::Zero());
  EXPECT_EQ(path.size(), 2U);
  const auto there = safe_path<Dim>(reachable, 0, 0, Vec<Dim>::Zero());  // Already there.
  EXPECT_EQ(there.size(), 2U);
}

TYPED_TEST(PathsTest, SameRegionsForAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const auto set = random_set<Dim>(9, 0.5, 700 - 660 * (Dim - 2));
  const auto labels = [&](int threads) {
    const ThreadLimit limit(threads);
    const Regions<Dim> regions = regions_of(set);
    std::vector<std::int32_t> all;
    for (std::size_t i = 0; i < set.values.size(); ++i) all.push_back(regions.region_of(i));
    return all;
  };
  EXPECT_EQ(labels(1), labels(2));
}

}  // namespace
}  // namespace vantage
