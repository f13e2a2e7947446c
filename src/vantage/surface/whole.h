// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/surface/tree.h"

namespace vantage {

/// Errors of the whole tree [m]: upper bounds, at most a tenth above the truth, for all its sites and all its patches. A leaf's own bounds may be
/// larger, for a point may be nearer to a neighbour's patch, and a patch to a neighbour's points. Leaves are looked at until one shows that the
/// bounds known without looking are as tight as that already; mostly this is soon. Makes leaves' bounds sharp on the way. Points
/// that paper mode drops do not count (farthest_site has them).
template <int Dim>
[[nodiscard]] typename LeafNode<Dim>::Sharp whole_errors(Tree<Dim>& tree);

}  // namespace vantage
