// SPDX-License-Identifier: Apache-2.0
// The smallest choice and its proof beside the optimum by trying all choices.
#include "vantage/cover/fewest.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/cover/bound.h"
#include "vantage/cover/tree_search.h"

namespace vantage {
namespace {

CoverProblem random_problem(std::uint64_t seed, std::size_t candidates, std::size_t demands) {
  Random random(seed);
  CoverProblem problem;
  const double share = random.uniform(0.1, 0.5);
  problem.need.assign(demands, 1);
  for (std::size_t c = 0; c < candidates; ++c) {
    auto& set = problem.sets.emplace_back();
    for (std::uint32_t i = 0; i < demands; ++i)
      if (random.uniform() < share || c == i % candidates) set.push_back(i);
  }
  if (seed % 3 == 0) problem.need[random.below(demands)] = 0;
  problem.spare = random.below(4);
  return problem;
}

std::size_t optimum(const CoverProblem& problem) {
  std::size_t least = problem.sets.size();
  for (std::uint32_t bits = 0; bits < 1U << problem.sets.size(); ++bits) {
    Choice choice;
    for (std::size_t c = 0; c < problem.sets.size(); ++c)
      if (bits >> c & 1U) choice.push_back(c);
    if (choice.size() < least && covers(problem, choice)) least = choice.size();
  }
  return least;
}

RC_GTEST_PROP(TreeSearch, FindsAChoiceExactlyWhereThereIsOne, (std::uint64_t seed)) {
  const CoverProblem problem = random_problem(seed, 3 + seed % 8, 1 + seed / 8 % 150);
  const std::size_t best = optimum(problem);
  Random random(seed, 2);
  std::vector<double> any;
  for (std::size_t i = 0; i < problem.need.size(); ++i) any.push_back(random.uniform());
  const std::vector<double> dual = cover_bound(problem, best, 100).prices;
  for (const std::vector<double>& prices : {std::vector<double>{}, any, dual})
    for (std::size_t size = 0; size <= problem.sets.size(); ++size) {
      std::int64_t work = 1'000'000'000;
      const TreeResult result = tree_search(problem, size, prices, work);
      RC_ASSERT(result.complete);
      RC_ASSERT(result.choice.has_value() == (size >= best));
      if (!result.choice) continue;
      RC_ASSERT(result.choice->size() <= size);
      RC_ASSERT(covers(problem, *result.choice));
    }
}

TEST(TreeSearch, SaysWhenItsWorkIsSpent) {
  const CoverProblem problem = random_problem(4, 10, 40);
  const std::size_t best = optimum(problem);
  std::int64_t work = 1;
  const TreeResult result = tree_search(problem, best - 1, {}, work);
  EXPECT_FALSE(result.complete);
  EXPECT_FALSE(result.choice);
  EXPECT_LE(work, 0);
}

TEST(TreeSearch, RefusesNeedsAboveOne) {
  std::int64_t work = 1000;
  EXPECT_THROW((void)tree_search({{{0}, {0}}, {2}, 0}, 2, {}, work), Error);
}

RC_GTEST_PROP(Fewest, IsTheOptimumOfSmallProblems, (std::uint64_t seed)) {
  const CoverProblem problem = random_problem(seed, 3 + seed % 8, 1 + seed / 8 % 40);
  const FewestCover fewest = fewest_cover(problem, greedy_cover(problem), 100'000'000);
  RC_ASSERT(covers(problem, fewest.choice));
  RC_ASSERT(fewest.proven());
  RC_ASSERT(fewest.choice.size() == optimum(problem));
  RC_ASSERT(fewest.relaxation <= static_cast<double>(fewest.at_least) + 1e-6);
}

RC_GTEST_PROP(Fewest, HoldsAfterAnyWork, (std::uint64_t seed)) {
  const CoverProblem problem = random_problem(seed, 3 + seed % 8, 1 + seed / 8 % 40);
  const std::size_t best = optimum(problem);
  const Choice greedy = greedy_cover(problem);
  for (const std::int64_t work : {0, 100, 10000}) {
    const FewestCover fewest = fewest_cover(problem, greedy, work);
    RC_ASSERT(covers(problem, fewest.choice));
    RC_ASSERT(fewest.choice.size() >= best && fewest.choice.size() <= greedy.size());
    RC_ASSERT(fewest.at_least <= best);
  }
}

TEST(Fewest, NothingIsAskedFor) {
  const FewestCover fewest = fewest_cover({{{0}, {1}}, {1, 1}, 2}, {0}, 1000);
  EXPECT_TRUE(fewest.choice.empty());
  EXPECT_TRUE(fewest.proven());
}

TEST(Fewest, RefusesAChoiceThatDoesNotCover) { EXPECT_THROW((void)fewest_cover({{{0}, {1}}, {1, 1}, 0}, {0}, 1000), Error); }

TEST(Fewest, SameForAnyNumberOfThreads) {
  const CoverProblem problem = random_problem(5, 60, 300);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return fewest_cover(problem, greedy_cover(problem), 3'000'000);
  };
  const FewestCover one = run(1), four = run(4);
  EXPECT_EQ(one.choice, four.choice);
  EXPECT_EQ(one.at_least, four.at_least);
  EXPECT_EQ(one.relaxation, four.relaxation);
}

}  // namespace
}  // namespace vantage
