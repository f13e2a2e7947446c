// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/links.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// A chain: each candidate covers two demands and shares one with the next.
CoverProblem chain(std::uint32_t length) {
  CoverProblem problem;
  for (std::uint32_t c = 0; c < length; ++c) problem.sets.push_back({c, c + 1});
  problem.need.assign(length + 1, 1);
  return problem;
}

TEST(Links, OverlapIsTheShareOfTheLaterOne) {
  const CoverProblem problem{{{0, 1, 2, 3}, {3}, {7}}, std::vector<std::uint32_t>(8, 1), 0};
  const Links links(problem, 8, 0.5);
  EXPECT_EQ(links.overlap(0, 1), 1.0);
  EXPECT_EQ(links.overlap(1, 0), 0.25);
  EXPECT_TRUE(links.linked(0, 1));
  EXPECT_FALSE(links.linked(1, 0));
  EXPECT_TRUE(links.in_order({0, 1}));
  EXPECT_FALSE(links.in_order({1, 0}));
  EXPECT_EQ(links.roots({1, 0}), Choice{0});
  EXPECT_EQ(links.unlinked({1, 0, 2}), Choice{2});
  EXPECT_TRUE(Links(problem, 8, 0.0).connected({0, 1, 2}));
}

TEST(Links, JoinsByTheFewestInBetween) {
  const Links links(chain(9), 10, 0.5);
  EXPECT_EQ(links.unlinked({0, 4}).size(), 1u);
  const Choice joined = links.joined({0, 4});
  EXPECT_EQ(joined.size(), 5u);
  EXPECT_TRUE(links.connected(joined));
  EXPECT_EQ(Links(chain(9), 10, 0.6).joined({0, 4}), (Choice{0, 4}));  // Nothing shares so much.
}

}  // namespace
}  // namespace vantage
