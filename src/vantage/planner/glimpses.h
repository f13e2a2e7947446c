// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/scan/scan.h"

namespace vantage {

/// Nodes that rays went by although they are not called seen: behind a slit narrower than the lattice, say. Where there are some, light gets in, and
/// what is unseen there is not enclosed.
template <int Dim>
  requires SpatialDim<Dim>
class Glimpses {
 public:
  /// Takes note of the unseen nodes along the last stretch of every ray. `view`: with this scan taken in. Cost: one look-up for a ray that ends where
  /// it is seen.
  void note(const BeliefView<Dim>& view, const Scan<Dim>& scan);

  /// Calls f(node) for those that are still unseen.
  template <class F>
  void for_each(const Field<Dim, NodeState>& state, F&& f) const {
    for (const std::size_t node : nodes_)
      if (state[node] == NodeState::unseen) f(node);
  }

 private:
  std::vector<std::size_t> nodes_;  // Ascending, none twice.
};

}  // namespace vantage
