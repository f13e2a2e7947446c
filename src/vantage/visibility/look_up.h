// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/visibility/seen_from.h"

namespace vantage {

/// What asking the nodes of a lattice one by one needs.
template <int Dim>
struct LookUp {
  const float* ranges = nullptr;  ///< Of the depth image [m].
  std::int32_t resolution = 0;    ///< Of the depth image.
  double spacing = 1.0;           ///< Of the lattice [m]
  double max_square = 0.0;        ///< Of the range [m^2]
  Vec<Dim> origin;                ///< Viewpoint [m].
};

/// sees() for every node of the block whose first node is `first` (a global lattice index), eight at a time: the same divisions and comparisons in
/// the same order, so the same answers, on any machine.
template <int Dim>
[[nodiscard]] typename SeenSet<Dim>::Bits look_up(const LookUp<Dim>& look, const Index<Dim>& first);

}  // namespace vantage
