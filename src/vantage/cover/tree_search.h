// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "vantage/cover/cover.h"

namespace vantage {

/// What trying all choices came to.
struct TreeResult {
  std::optional<Choice> choice;  ///< One that covers what is asked for.
  bool complete = true;          ///< All were tried or ruled out: without a choice, none is so small. False: the work was spent.
};

/// Is there a choice of at most `size` candidates? Depth first, the most gainful candidate next; what is left of a branch is cut off where even the
/// best candidates together, each for itself, would not cover enough: counted in demands, or weighed by `prices` >= 0 (those of CoverBound cut most;
/// empty: none), of which the dearest `spare` may stay short. Every demand needs one candidate at most. `work` is the number of elementary steps that
/// may be taken and falls by those that were, so the result depends on the arguments alone. Throws bad_input for a need above 1.
[[nodiscard]] TreeResult tree_search(const CoverProblem& problem, std::size_t size, std::span<const double> prices, std::int64_t& work);

}  // namespace vantage
