// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// Where a front starts: a node's linear index and its arrival value [m].
using Seed = std::pair<std::size_t, float>;

/// First-order upwind solution of |grad u| = 1 over the nodes where `passable` is non-zero, u = seed at the seeds, infinity where the front does not
/// get (Sethian 1996). Ties by node index, so the result is a function of the input alone.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> fast_march(const Field<Dim, std::uint8_t>& passable, std::span<const Seed> seeds);

/// The same towards one `target`: nodes are taken in order of u plus the straight distance to it, as A* does, and the rest stays at infinity. Values may lie
/// a little above those of the full front; every finite node but a seed still has a lower neighbour. Cost: the nodes along the way, not all.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> fast_march_to(const Field<Dim, std::uint8_t>& passable, std::span<const Seed> seeds, std::size_t target);

template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] std::vector<Vec<Dim>> descend(const Field<Dim>& arrival, std::size_t from);

}  // namespace vantage
