// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "vantage/base/random.h"

namespace vantage {

/// `count` of `all`, in their order, one drawn from each of as many equal stretches; all of them if there are no more.
[[nodiscard]] inline std::vector<std::size_t> draw(const std::vector<std::size_t>& all, std::size_t count, Random& random) {
  if (all.size() <= count) return all;
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * all.size() / count, end = (k + 1) * all.size() / count;
    drawn.push_back(all[begin + random.below(end - begin)]);
  }
  return drawn;
}

}  // namespace vantage
