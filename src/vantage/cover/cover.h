// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vantage {

/// Sets of demands, of which the fewest are to be chosen such that every demand lies in as many of them as it needs (multi-cover).
struct CoverProblem {
  std::vector<std::vector<std::uint32_t>> sets;  ///< Per candidate the demands that it covers, ascending.
  std::vector<std::uint32_t> need;               ///< Per demand; at most the candidates that cover it.
  std::size_t spare = 0;                         ///< So many demands may be left short.
};

/// Indices of candidates.
using Choice = std::vector<std::size_t>;

/// Whether every demand, but for at most `spare` of them, is covered as often as it needs.
[[nodiscard]] bool covers(const CoverProblem& problem, std::span<const std::size_t> choice);

/// Always the candidate with the largest sum of prices over the demands that are still short, the smaller index at a tie; in the order chosen.
/// `prices` may be empty: 1 each. Lazy: gains can only fall (Minoux 1978). At most H(largest set) times the optimum with prices of 1.
[[nodiscard]] Choice greedy_cover(const CoverProblem& problem, std::span<const double> prices = {});

/// What a choice must fulfil besides; empty: nothing.
using Acceptable = std::function<bool(const Choice&)>;

/// Without candidates that are not needed, and with one candidate in the place of two wherever that does, until neither can be done any more. A
/// demand that the choice covers stays covered, and an acceptable choice acceptable.
[[nodiscard]] Choice improved(const CoverProblem& problem, Choice choice, const Acceptable& acceptable = {});

/// A smaller choice that covers what is asked for, as `choice` does, if one is found: takes candidates out one at a time and repairs by others,
/// demands that are hard to cover weighing more with every step (Gao, Weise and Li 2015). Ends after about `work` elementary steps, so it depends on
/// the arguments alone.
[[nodiscard]] Choice weighted_search(const CoverProblem& problem, const Choice& choice, std::uint64_t seed, std::int64_t work);

/// The demands as bits, 64 a word, for counting what two candidates share.
[[nodiscard]] std::vector<std::uint64_t> as_bits(std::span<const std::uint32_t> set, std::size_t demands);

}  // namespace vantage
