// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// A way from `here` to the node `target`: straight to the node `first` beside it, then through reachable nodes (1) only: the shortest over steps to
/// all 3^Dim - 1 neighbours (A*; a diagonal step needs every node it passes between), then pulled taut. A few per cent longer than the shortest at
/// worst. Only the two places if `target` cannot be reached. Cost: in proportion to the nodes searched.
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> safe_path(const Field<Dim, std::uint8_t>& reachable, std::size_t first, std::size_t target, const Vec<Dim>& here);

}  // namespace vantage
