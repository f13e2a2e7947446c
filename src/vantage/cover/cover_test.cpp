// SPDX-License-Identifier: Apache-2.0
// Set cover and its bound beside the optimum by trying all choices.
#include "vantage/cover/cover.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <numeric>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/cover/bound.h"

namespace vantage {
namespace {

/// A small problem that can be met: `share` of the pairs are covers.
CoverProblem random_problem(std::uint64_t seed, std::size_t candidates, std::size_t demands) {
  Random random(seed);
  CoverProblem problem;
  const double share = random.uniform(0.1, 0.5);
  std::vector<std::uint32_t> owners(demands);
  for (std::size_t c = 0; c < candidates; ++c) {
    auto& set = problem.sets.emplace_back();
    for (std::uint32_t i = 0; i < demands; ++i)
      if (random.uniform() < share || c == i % candidates) set.push_back(i), ++owners[i];
  }
  for (std::size_t i = 0; i < demands; ++i)
    problem.need.push_back(std::min<std::uint32_t>(owners[i], 1 + static_cast<std::uint32_t>(random.below(3))));
  problem.spare = random.below(3);
  return problem;
}

Choice from_bits(std::uint32_t bits) {
  Choice choice;
  for (std::size_t c = 0; c < 32; ++c)
    if (bits >> c & 1U) choice.push_back(c);
  return choice;
}

/// Size of the smallest choice that covers what is asked for.
std::size_t optimum(const CoverProblem& problem) {
  std::size_t least = problem.sets.size();
  for (std::uint32_t bits = 0; bits < 1U << problem.sets.size(); ++bits) {
    const auto size = static_cast<std::size_t>(std::popcount(bits));
    if (size < least && covers(problem, from_bits(bits))) least = size;
  }
  return least;
}

RC_GTEST_PROP(Cover, BoundIsAtMostTheOptimumAndWhatIsFoundAtLeast, (std::uint64_t seed)) {
  const CoverProblem problem = random_problem(seed, 3 + seed % 8, 1 + seed / 8 % 16);
  const std::size_t best = optimum(problem);
  const Choice greedy = greedy_cover(problem);
  RC_ASSERT(covers(problem, greedy));
  RC_ASSERT(greedy.size() >= best);
  const Choice smaller = improved(problem, greedy);
  RC_ASSERT(covers(problem, smaller));
  RC_ASSERT(smaller.size() >= best && smaller.size() <= greedy.size());
  const Choice searched = weighted_search(problem, greedy, seed, 20000);
  RC_ASSERT(covers(problem, searched));
  RC_ASSERT(searched.size() >= best && searched.size() <= greedy.size());
  const CoverBound bound = cover_bound(problem, greedy.size());
  RC_ASSERT(bound.candidates <= best);
  for (const int steps : {1, 2, 5}) RC_ASSERT(cover_bound(problem, greedy.size(), steps).candidates <= best);
}

TEST(Cover, SearchFindsTheOptimumOfSmallProblems) {
  int by_search = 0, by_bound = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CoverProblem problem = random_problem(seed, 12, 24);
    problem.spare = 0;
    const std::size_t best = optimum(problem);
    by_search += weighted_search(problem, greedy_cover(problem), seed, 200000).size() == best ? 1 : 0;
    by_bound += cover_bound(problem, best).candidates == best ? 1 : 0;
    ++all;
  }
  EXPECT_EQ(by_search, all);
  EXPECT_GE(by_bound, all * 9 / 10);
}

TEST(Cover, ImprovedDropsTheNeedlessAndPutsOneForTwo) {
  // 0 and 1 together, or 2 alone; 3 adds nothing.
  const CoverProblem problem{{{0, 1}, {2, 3}, {0, 1, 2, 3}, {1, 2}}, {1, 1, 1, 1}, 0};
  EXPECT_EQ(improved(problem, {0, 1}), Choice{2});
  EXPECT_EQ(improved(problem, {3, 2}), Choice{2});
  EXPECT_EQ(improved(problem, {0, 1}, [](const Choice& choice) { return choice.size() > 1; }).size(), 2u);
}

TEST(Cover, EachDemandAsOftenAsItNeeds) {
  const CoverProblem problem{{{0, 1}, {0, 1}, {0}, {1}}, {2, 2}, 0};
  EXPECT_EQ(greedy_cover(problem), (Choice{0, 1}));
  EXPECT_FALSE(covers(problem, Choice{0}));
  EXPECT_EQ(cover_bound(problem, 2).candidates, 2u);
}

TEST(Cover, TheSpareAreLeftOut) {
  CoverProblem problem{{{0, 1, 2}, {3}, {4}}, {1, 1, 1, 1, 1}, 2};
  EXPECT_EQ(greedy_cover(problem), Choice{0});
  EXPECT_EQ(cover_bound(problem, 1).candidates, 1u);
  problem.spare = 1;
  EXPECT_EQ(greedy_cover(problem).size(), 2u);
  problem.spare = 5;
  EXPECT_TRUE(greedy_cover(problem).empty());
  EXPECT_EQ(cover_bound(problem, 0).candidates, 0u);
}

TEST(Cover, OneCandidateEachIsBoundByThemAll) {
  CoverProblem problem;
  for (std::uint32_t i = 0; i < 40; ++i) problem.sets.push_back({i}), problem.need.push_back(1);
  EXPECT_EQ(cover_bound(problem, 40).candidates, 40u);
}

TEST(Cover, SameForAnyNumberOfThreads) {
  const CoverProblem problem = random_problem(5, 60, 300);
  const auto bound = [&](int threads) {
    const ThreadLimit limit(threads);
    return cover_bound(problem, 20).prices;
  };
  EXPECT_EQ(bound(1), bound(4));
}

}  // namespace
}  // namespace vantage
