// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/cover/cover.h"

namespace vantage {

/// Which stations can be registered to which by the wall that both see.
class Links {
 public:
  /// A candidate is linked from another one if at least `share` [1] of what it covers, the other covers too; demands from `count` on do not enter.
  /// Cost: all pairs of candidates once, unless `share` is 0, with which all are linked.
  Links(const CoverProblem& problem, std::size_t count, double share);

  /// Share of what `later` covers that `earlier` covers too; 1 if it covers nothing.
  [[nodiscard]] double overlap(std::size_t earlier, std::size_t later) const;
  [[nodiscard]] bool linked(std::size_t earlier, std::size_t later) const {
    return links_.empty() || (links_[earlier][later / 64] >> (later % 64) & 1U) != 0;
  }
  /// Every station but the first is linked from an earlier one.
  [[nodiscard]] bool in_order(const Choice& order) const;
  /// Some order of them is such.
  [[nodiscard]] bool connected(const Choice& choice) const { return unlinked(choice).empty(); }
  /// Stations that are not reached by links from the one from which most are.
  [[nodiscard]] Choice unlinked(const Choice& choice) const;
  /// Stations from which all others are reached: with one of them an order can begin.
  [[nodiscard]] Choice roots(const Choice& choice) const;
  /// With further candidates, for each station in turn as few as a path of links needs. What cannot be joined stays apart.
  [[nodiscard]] Choice joined(Choice choice) const;

 private:
  [[nodiscard]] Choice reached(const Choice& choice, std::size_t root) const;

  std::vector<std::vector<std::uint64_t>> bits_;   ///< What a candidate covers.
  std::vector<std::vector<std::uint64_t>> links_;  ///< Candidates that are linked from it; empty: all are.
  std::vector<std::size_t> size_;
};

}  // namespace vantage
