// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// One walk past several stations.
template <int Dim>
struct NextTour {
  std::vector<std::size_t> order;  ///< Of the stations, as numbered by the caller from 0.
  std::vector<Vec<Dim>> path;      ///< From where one is to the last of them [m]; straight where no way is known.
  double length = 0.0;             ///< Of the path [m].
};

/// A short way from `here` past all `stations` over the `passable` nodes (1, else 0), which ends at the last: nearest neighbour, then exchanges.
template <int Dim>
[[nodiscard]] NextTour<Dim> tour_past(const Field<Dim, std::uint8_t>& passable, const Vec<Dim>& here, std::span<const Vec<Dim>> stations);

}  // namespace vantage
