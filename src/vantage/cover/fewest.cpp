// SPDX-License-Identifier: Apache-2.0
#include "vantage/cover/fewest.h"

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/cover/bound.h"
#include "vantage/cover/tree_search.h"

namespace vantage {
namespace {

constexpr std::uint64_t kSeed = 1;

class Narrowing {
 public:
  Narrowing(const CoverProblem& problem, const Choice& known) : problem_(problem) {
    require(covers(problem, known), "fewest_cover: the known choice does not cover what is asked for");
    best_.choice = improved(problem, known);
    const auto missing = std::count_if(problem.need.begin(), problem.need.end(), [](std::uint32_t n) { return n > 0; });
    best_.at_least = static_cast<std::size_t>(missing) > problem.spare ? 1 : 0;
    for (const auto& set : problem.sets) pairs_ += static_cast<std::int64_t>(set.size());
  }

  /// Small problems are closed by the tree, large ones by prices; the search is for those between.
  FewestCover run(std::int64_t work) {
    bound(std::min(work / 20, 100 * pairs_));
    tree(work / 10);
    if (!best_.proven()) take(weighted_search(problem_, best_.choice, kSeed, work / 20));
    bound(work / 2);
    tree(work / 4);
    return std::move(best_);
  }

 private:
  void take(const Choice& choice) {
    if (choice.size() < best_.choice.size()) best_.choice = choice;
  }

  void bound(std::int64_t work) {
    const auto steps = static_cast<int>(std::min<std::int64_t>(work / std::max<std::int64_t>(pairs_, 1), 4000));
    if (best_.proven() || steps < 1) return;
    const CoverBound found = cover_bound(problem_, best_.choice.size(), steps);
    if (found.value < best_.relaxation) return;
    best_.relaxation = found.value;
    best_.at_least = std::max(best_.at_least, found.candidates);
    prices_ = found.prices;
  }

  /// One candidate fewer at a time, down to the bound.
  void tree(std::int64_t work) {
    while (!best_.proven()) {
      const TreeResult result = tree_search(problem_, best_.choice.size() - 1, prices_, work);
      if (result.choice)
        take(*result.choice);
      else if (result.complete)
        best_.at_least = best_.choice.size();
      else
        return;
    }
  }

  const CoverProblem& problem_;
  FewestCover best_;
  std::vector<double> prices_;
  std::int64_t pairs_ = 0;  ///< Candidate and demand.
};

}  // namespace

FewestCover fewest_cover(const CoverProblem& problem, const Choice& known, std::int64_t work) { return Narrowing(problem, known).run(work); }

}  // namespace vantage
