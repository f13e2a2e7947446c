// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/planner/ray_march.h"

namespace vantage {

/// Candidates whose gain can only fall as scans arrive, so that an old gain is a bound and few need another look (Minoux 1978). One a block of the
/// lattice: the first of its nodes that is offered stays while it may be stood on.
template <int Dim>
  requires SpatialDim<Dim>
class LazyPool {
 public:
  struct Gain {
    std::size_t node = 0;
    double volume = 0.0;
  };
  /// Blocks as small as 4 nodes along a side, but at most `most_blocks` of them.
  LazyPool(const Grid<Dim>& window, std::size_t most_blocks);

  void offer(std::span<const std::size_t> nodes);
  /// A gain has risen somewhere: the bounds are no longer any.
  void forget();
  /// RayMarch::unseen_volume() of those that were looked at, the largest of all candidates first, ties by node. Only nodes that are reachable (1) and
  /// not within 2 h of `visited` take part. Empty if there are none. Same result as looking at all of them.
  [[nodiscard]] std::vector<Gain> best(const RayMarch<Dim>& rays, std::span<const Vec<Dim>> directions, const Field<Dim, std::uint8_t>& reachable,
                                       std::span<const Vec<Dim>> visited);

 private:
  Grid<Dim> window_, blocks_;
  int side_ = 4;
  std::vector<Gain> pool_;           // volume: a bound.
  std::vector<std::uint8_t> taken_;  // Per block.
};

}  // namespace vantage
