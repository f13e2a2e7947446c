// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/cover/cover.h"

namespace vantage {

/// The smallest choice that was found, and a proof of how small it could be at best.
struct FewestCover {
  Choice choice;
  std::size_t at_least = 0;  ///< No choice with fewer candidates covers what is asked for.
  double relaxation = 0.0;   ///< The bound before it was rounded up, by Lagrangian duality alone; 0 where it was not needed.

  [[nodiscard]] bool proven() const { return choice.size() == at_least; }
};

/// Makes `known`, a choice that covers what is asked for, smaller by improved(), weighted_search() and tree_search(), and raises the bound by
/// cover_bound() and tree_search() until they meet or about `work` elementary steps are spent; it depends on the arguments alone. Every demand needs
/// one candidate at most. Throws bad_input for a choice that does not cover what is asked for. Same bits for any number of threads.
[[nodiscard]] FewestCover fewest_cover(const CoverProblem& problem, const Choice& known, std::int64_t work);

}  // namespace vantage
