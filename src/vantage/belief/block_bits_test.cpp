// SPDX-License-Identifier: Apache-2.0
#include "vantage/belief/block_bits.h"

#include <gtest/gtest.h>

#include "vantage/base/random.h"
#include "vantage/belief/block_values.h"

namespace vantage {
namespace {

template <class T>
class BlockBitsOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BlockBitsOf, Dimensions);

template <int Dim>
Grid<Dim> odd_window() {
  Grid<Dim> window{0.5, Index<Dim>::Constant(-13), Index<Dim>::Constant(37)};
  window.extent[0] = 43;
  return window;
}

/// A window that may stick out of the other, positive on about `share` of its nodes.
template <int Dim>
Field<Dim> random_view(const Grid<Dim>& whole, double share, Random& random) {
  Grid<Dim> window = whole;
  for (int a = 0; a < Dim; ++a) {
    window.first[a] += static_cast<std::int32_t>(random.uniform(-10.0, 30.0));
    window.extent[a] = 1 + static_cast<std::int32_t>(random.uniform(0.0, 30.0));
  }
  Field<Dim> phi(window);
  for (float& value : phi.values) value = random.uniform() < share ? 1.0F : -1.0F;
  return phi;
}

/// Oracle: a byte a node.
TYPED_TEST(BlockBitsOf, IsTheUnionOfWhatWasAdded) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> whole = odd_window<Dim>();
  for (const double share : {0.02, 0.5, 1.0}) {
    BlockBits<Dim> bits(whole);
    Field<Dim, std::uint8_t> oracle(whole);
    Random random(7);
    for (int k = 0; k < 12; ++k) {
      const Field<Dim> phi = random_view(whole, share, random);
      bits.add(phi);
      for (std::size_t i = 0; i < phi.values.size(); ++i) {
        const Index<Dim> at = phi.window.local(i) + phi.window.first - whole.first;
        if (phi[i] > 0.0F && whole.inside(at)) oracle.at(at) = 1;
      }
      for (std::size_t i = 0; i < oracle.values.size(); ++i) ASSERT_EQ(bits[i], oracle[i] != 0);
    }
    std::vector<std::uint8_t> row(23);
    Index<Dim> start = Index<Dim>::Constant(5);
    bits.read_row(start, row);
    for (std::size_t k = 0; k < row.size(); ++k, ++start[0]) EXPECT_EQ(row[k], oracle.at(start));
  }
}

TYPED_TEST(BlockBitsOf, UniformBlocksCostNothing) {
  constexpr int Dim = TypeParam::value;
  const Grid<Dim> whole = odd_window<Dim>();
  BlockBits<Dim> bits(whole);
  const std::size_t empty = bits.bytes();
  Field<Dim> half(whole, 1.0F);
  half.window.extent[0] = 20;
  half.values.resize(half.window.size());
  bits.add(half);
  EXPECT_GT(bits.mixed_blocks(), 0U);  // 20 is no multiple of 8.
  bits.add(Field<Dim>(whole, 1.0F));
  EXPECT_EQ(bits.mixed_blocks(), 0U);
  bits.add(Field<Dim>(whole, -1.0F));
  for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_TRUE(bits[i]);
  BlockBits<Dim> once(whole);
  once.add(Field<Dim>(whole, 1.0F));
  EXPECT_EQ(once.bytes(), empty);
}

TYPED_TEST(BlockBitsOf, ValuesRestUntilWritten) {
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
