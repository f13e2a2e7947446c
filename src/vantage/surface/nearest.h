// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/surface/tree.h"

namespace vantage {

/// delta(D, S) over the whole tree [m], a certified upper bound: every site against all patches. For trees that drop points (paper mode), where the
/// leaves' own bounds do not tell. 0 without sites, infinite with sites and no patch.
template <int Dim>
[[nodiscard]] double farthest_site(const Tree<Dim>& tree);

}  // namespace vantage
