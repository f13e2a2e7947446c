// SPDX-License-Identifier: Apache-2.0
#include "vantage/belief/block_values.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

template <class T>
class BlockValuesOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BlockValuesOf, Dimensions);

template <int Dim>
Grid<Dim> odd_window() {
  Grid<Dim> window{0.5, Index<Dim>::Constant(-13), Index<Dim>::Constant(37)};
  window.extent[0] = 43;
  return window;
}

TYPED_TEST(BlockValuesOf, RestUntilWritten) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> whole = odd_window<Dim>();
  BlockValues<Dim> values(whole, 9.0F);
  const std::size_t empty = values.bytes();
  Index<Dim> at = Index<Dim>::Constant(21);
  EXPECT_EQ(values.run(at), nullptr);
  values.at(at) = 2.5F;
  EXPECT_EQ(values(at), 2.5F);
  ASSERT_NE(values.run(at), nullptr);
  EXPECT_EQ(values.run(at)[0], 2.5F);
  at[0] += 1;
  EXPECT_EQ(values(at), 9.0F);
  at[0] += 4;
  EXPECT_EQ(values.run(at), nullptr);
  EXPECT_GT(values.bytes(), empty);
}

}  // namespace
}  // namespace vantage
