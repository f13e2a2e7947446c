// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/seen_set.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "vantage/base/random.h"

namespace vantage {
namespace {

template <class T>
class SeenSetOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SeenSetOf, Dimensions);

template <int Dim>
Grid<Dim> odd_window() {
  Grid<Dim> window{0.5, Index<Dim>::Constant(-13), Index<Dim>::Constant(37)};
  window.extent[0] = 43;
  return window;
}

/// A window that may stick out of the other.
template <int Dim>
Grid<Dim> random_window(const Grid<Dim>& whole, Random& random) {
  Grid<Dim> window = whole;
  for (int a = 0; a < Dim; ++a) {
    window.first[a] += static_cast<std::int32_t>(random.uniform(-10.0, 30.0));
    window.extent[a] = 1 + static_cast<std::int32_t>(random.uniform(0.0, 30.0));
  }
  return window;
}

/// Oracle: a byte a node.
TYPED_TEST(SeenSetOf, UnionHoldsWhatAnyOneHolds) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> whole = odd_window<Dim>();
  for (const double share : {0.02, 0.5, 1.0}) {
    SeenSet<Dim> sum(whole);
    Field<Dim, std::uint8_t> oracle(whole);
    Random random(7);
    for (int k = 0; k < 12; ++k) {
      Field<Dim, std::uint8_t> nodes(random_window(whole, random));
      for (auto& node : nodes.values) node = random.uniform() < share;
      sum.unite(SeenSet<Dim>(nodes));
      for (std::size_t i = 0; i < nodes.values.size(); ++i) {
        const Index<Dim> at = nodes.window.local(i) + nodes.window.first - whole.first;
        if (nodes[i] != 0 && whole.inside(at)) oracle.at(at) = 1;
      }
      for (std::size_t i = 0; i < oracle.values.size(); ++i) ASSERT_EQ(sum.at(whole.local(i)), oracle[i] != 0);
    }
    ASSERT_EQ(sum.count(), static_cast<std::size_t>(std::count(oracle.values.begin(), oracle.values.end(), 1)));
    std::vector<std::uint8_t> row(23);
    Index<Dim> start = Index<Dim>::Constant(5);
    sum.read_row(start, row);
    for (std::size_t k = 0; k < row.size(); ++k, ++start[0]) EXPECT_EQ(row[k], oracle.at(start));
  }
}

TYPED_TEST(SeenSetOf, UniformBlocksCostNoBits) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> whole{0.5, Index<Dim>::Constant(-16), Index<Dim>::Constant(40)};
  SeenSet<Dim> sum(whole);
  const std::size_t empty = sum.bytes();
  Grid<Dim> half = whole;
  half.extent[0] = 20;
  sum.unite(SeenSet<Dim>(Field<Dim, std::uint8_t>(half, 1)));
  EXPECT_GT(sum.mixed(), 0U);  // 20 is no multiple of 8.
  sum.unite(SeenSet<Dim>(Field<Dim, std::uint8_t>(whole, 1)));
  EXPECT_EQ(sum.mixed(), 0U);
  EXPECT_EQ(sum.count(), whole.size());
  SeenSet<Dim> once(whole);
  once.unite(SeenSet<Dim>(Field<Dim, std::uint8_t>(whole, 1)));
  EXPECT_EQ(once.bytes(), empty);
}

}  // namespace
}  // namespace vantage
