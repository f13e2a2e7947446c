// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/cover/cover.h"

namespace vantage {

/// A proof that no choice with fewer candidates covers what is asked for.
struct CoverBound {
  double value = 0.0;          ///< Lower bound of the linear relaxation.
  std::size_t candidates = 0;  ///< The next whole number: so many are needed.
  std::vector<double> prices;  ///< Per demand, of the best bound: large where few candidates help.
};

/// Lower bound by Lagrangian duality. For any prices y >= 0 and any choice C that leaves at most `spare` demands short,
/// |C| >= sum_i need_i y_i - (the `spare` largest need_i y_i) + sum_j min(0, 1 - sum_{i in set j} y_i);
/// subgradient steps look for good prices (Held and Karp 1971), with `best_known`, the size of a choice that is known, for the length of the step.
/// Valid after any number of steps. Same bits for any number of threads.
[[nodiscard]] CoverBound cover_bound(const CoverProblem& problem, std::size_t best_known, int steps = 4000);

}  // namespace vantage
