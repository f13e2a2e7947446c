// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// Where a front starts: a node's linear index and its arrival value [m].
using Seed = std::pair<std::size_t, float>;

/// First-order upwind solution of |grad u| = 1 over the nodes where `passable` is non-zero, u = seed at the seeds, infinity where the front does not
/// get (Sethian 1996). Ends early once `target` (if given) is reached. Ties by node index, so the result is a function of the input alone.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> fast_march(const Field<Dim, std::uint8_t>& passable, std::span<const Seed> seeds, std::optional<std::size_t> target = std::nullopt);

/// Shortest way from `from` down the arrival values to a node of value 0: steepest of the face and diagonal neighbours at finite values, whose
/// in-between nodes are passable too; then shortened where the straight line stays on finite nodes. Empty if `from` was not reached. [m]
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] std::vector<Vec<Dim>> descend(const Field<Dim>& arrival, std::size_t from);

}  // namespace vantage
