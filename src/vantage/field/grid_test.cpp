// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/grid.h"

#include <gtest/gtest.h>

#include <set>
#include <type_traits>
#include <vector>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/field/field.h"

namespace vantage {
namespace {

template <class Dimension>
class GridOf : public testing::Test {
 protected:
  Random random{7};
};

template <int Dim>
Vec<Dim> random_place(Random& random, double size) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = random.uniform(-size, size);
  return p;
}

template <int Dim>
Box<Dim> random_box(Random& random, double size) {
  Box<Dim> box;
  box.extend(random_place<Dim>(random, size));
  box.extend(random_place<Dim>(random, size));
  return box;
}

template <int Dim>
Grid<Dim> sample() {
  Grid<Dim> grid;
  grid.spacing = 0.25;
  for (int a = 0; a < Dim; ++a) {
    grid.first[a] = -3 + 2 * a;
    grid.extent[a] = 4 + a;
  }
  return grid;
}

/// Global indices of all nodes.
template <int Dim>
std::set<std::vector<std::int32_t>> nodes(const Grid<Dim>& grid) {
  std::set<std::vector<std::int32_t>> all;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Index<Dim> global = grid.first + grid.local(i);
    all.emplace(global.data(), global.data() + Dim);
  }
  return all;
}

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(GridOf, Dimensions);

TYPED_TEST(GridOf, WindowCoversTheBoxAndNoNodeIsSpare) {
  constexpr int Dim = TypeParam::value;
  for (const double h : {0.1, 0.5, 0.7, 3.0}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Box<Dim> box = random_box<Dim>(this->random, 20.0);
      const Box<Dim> covered = window_over(box, h).bounds();
      for (int a = 0; a < Dim; ++a) {
        EXPECT_LE(covered.low[a], box.low[a] + 1e-8 * h);
        EXPECT_GE(covered.high[a], box.high[a] - 1e-8 * h);
        EXPECT_GT(covered.low[a] + h, box.low[a]) << "one row of nodes fewer would do";
        EXPECT_LT(covered.high[a] - h, box.high[a]) << "one row of nodes fewer would do";
      }
    }
  }
}

TYPED_TEST(GridOf, BoxWithItsFacesOnNodesKeepsThem) {
  constexpr int Dim = TypeParam::value;
  for (const double h : {0.1, 0.3, 0.5, 1.0 / 3.0}) {
    Box<Dim> box;
    box.extend(Vec<Dim>::Constant(-7.0 * h));
    box.extend(Vec<Dim>::Constant(11.0 * h));
    const Grid<Dim> grid = window_over(box, h);
    EXPECT_EQ(grid.first, Index<Dim>::Constant(-7)) << h;
    EXPECT_EQ(grid.extent, Index<Dim>::Constant(19)) << h;
  }
}

TYPED_TEST(GridOf, PointGivesOneNodeOrItsNeighbours) {
  constexpr int Dim = TypeParam::value;
  EXPECT_EQ(window_over(Box<Dim>{Vec<Dim>::Zero(), Vec<Dim>::Zero()}, 0.5).size(), 1U);
  EXPECT_EQ(window_over(Box<Dim>{Vec<Dim>::Constant(0.3), Vec<Dim>::Constant(0.3)}, 0.5).size(), std::size_t{1} << Dim);
}

TYPED_TEST(GridOf, EmptyOrHugeBoxIsRefused) {
  constexpr int Dim = TypeParam::value;
  EXPECT_THROW((void)window_over(Box<Dim>{}, 0.5), Error);
  EXPECT_THROW((void)window_over(Box<Dim>{Vec<Dim>::Zero(), Vec<Dim>::Constant(1e9)}, 0.5), Error);
}

TYPED_TEST(GridOf, LinearAndLocalAreInverse) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> grid = sample<Dim>();
  std::size_t expected = 1;
  for (int a = 0; a < Dim; ++a) expected *= static_cast<std::size_t>(4 + a);
  ASSERT_EQ(grid.size(), expected);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Index<Dim> local = grid.local(i);
    EXPECT_TRUE(grid.inside(local));
    EXPECT_EQ(grid.linear(local), i);
  }
}

TYPED_TEST(GridOf, StrideIsOneStepAlongItsAxis) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> grid = sample<Dim>();
  EXPECT_EQ(grid.stride(0), 1U);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (int a = 0; a < Dim; ++a) {
      const Index<Dim> next = grid.local(i) + Index<Dim>::Unit(a);
      if (grid.inside(next)) {
        EXPECT_EQ(grid.linear(next), i + grid.stride(a));
      }
    }
  }
}

TYPED_TEST(GridOf, InsideEndsAtTheExtent) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> grid = sample<Dim>();
  const Index<Dim> last = grid.extent.array() - 1;
  EXPECT_TRUE(grid.inside(Index<Dim>::Zero()));
  EXPECT_TRUE(grid.inside(last));
  for (int a = 0; a < Dim; ++a) {
    EXPECT_FALSE(grid.inside(-Index<Dim>::Unit(a)));
    EXPECT_FALSE(grid.inside(last + Index<Dim>::Unit(a)));
  }
}

TYPED_TEST(GridOf, NearestNodeIsTheNearest) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> grid = sample<Dim>();
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_EQ(grid.nearest(grid.position(i)), grid.local(i));
  for (int trial = 0; trial < 200; ++trial) {
    const Vec<Dim> p = random_place<Dim>(this->random, 5.0);
    EXPECT_LE((grid.position(grid.nearest(p)) - p).cwiseAbs().maxCoeff(), 0.5 * grid.spacing * (1 + 1e-12));
  }
}

TYPED_TEST(GridOf, WindowsOfOneLatticeShareTheirNodesBitForBit) {
  constexpr int Dim = TypeParam::value;
  for (const double h : {0.1, 0.7}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Grid<Dim> a = window_over(random_box<Dim>(this->random, 6.0), h), b = window_over(random_box<Dim>(this->random, 6.0), h);
      const Grid<Dim> shared = intersection(a, b);
      for (std::size_t i = 0; i < shared.size(); ++i) {
        const Index<Dim> global = shared.first + shared.local(i);
        EXPECT_EQ(a.position(Index<Dim>(global - a.first)), b.position(Index<Dim>(global - b.first)));
        EXPECT_EQ(a.position(Index<Dim>(global - a.first)), shared.position(i));
      }
    }
  }
}

TYPED_TEST(GridOf, CoarseNodesAreEverySecondOfTheFineLattice) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> coarse = window_over(random_box<Dim>(this->random, 6.0), 0.7);
  Grid<Dim> fine = coarse;
  fine.spacing = 0.35;
  fine.first = 2 * coarse.first;
  for (std::size_t i = 0; i < coarse.size(); ++i) EXPECT_EQ(coarse.position(i), fine.position(Index<Dim>(2 * coarse.local(i))));
}

TYPED_TEST(GridOf, IntersectionIsTheCommonNodes) {
  constexpr int Dim = TypeParam::value;
  for (int trial = 0; trial < 30; ++trial) {
    const Grid<Dim> a = window_over(random_box<Dim>(this->random, 6.0), 2.0), b = window_over(random_box<Dim>(this->random, 6.0), 2.0);
    std::set<std::vector<std::int32_t>> common;
    for (const auto& node : nodes(b))
      if (nodes(a).contains(node)) common.insert(node);
    EXPECT_EQ(nodes(intersection(a, b)), common);
    EXPECT_EQ(nodes(intersection(b, a)), common);
    EXPECT_EQ(intersection(a, a), a);
  }
}

TYPED_TEST(GridOf, PaddedGrowsOnEverySide) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> grid = sample<Dim>(), big = padded(grid, 3);
  EXPECT_EQ(big.extent, Index<Dim>(grid.extent.array() + 6));
  EXPECT_EQ(big.first, Index<Dim>(grid.first.array() - 3));
  EXPECT_EQ(intersection(big, grid), grid);
  EXPECT_EQ(padded(big, -3), grid);
}

TYPED_TEST(GridOf, FieldHoldsOneValueANode) {
  constexpr int Dim = TypeParam::value;
  Field<Dim, int> field(sample<Dim>(), -1);
  ASSERT_EQ(field.values.size(), field.window.size());
  for (std::size_t i = 0; i < field.values.size(); ++i) field.at(field.window.local(i)) = static_cast<int>(i);
  for (std::size_t i = 0; i < field.values.size(); ++i) EXPECT_EQ(field[i], static_cast<int>(i));
}

}  // namespace
}  // namespace vantage
