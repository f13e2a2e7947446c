// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>

#include "vantage/field/fast_marching.h"

namespace vantage {

/// Ways between places through free nodes.
struct TravelTable {
  std::size_t count = 0;
  std::vector<double> metres;  ///< (count, count), symmetric.
  [[nodiscard]] double operator()(std::size_t a, std::size_t b) const { return metres[a * count + b]; }
};

/// Fast-marching distances from each place over the `passable` nodes. A lattice too large for so many fronts is thinned out first; where that cuts
/// the way, the straight distance stands for it: the table orders stations, `way_between` measures.
template <int Dim>
[[nodiscard]] TravelTable travel_table(const Field<Dim, std::uint8_t>& passable, std::span<const Vec<Dim>> places);

/// Whether an order of visits, or its beginning, is allowed; empty: all are.
using OrderRule = std::function<bool(const std::vector<std::size_t>&)>;

/// Order in which the places are visited, 0 first: nearest neighbour, then 2-opt and moves of one place (Or-opt) while they shorten it. With
/// `come_back` the way from the last to the first counts. Only orders that the rule allows are taken, if the nearest neighbour finds one.
[[nodiscard]] std::vector<std::size_t> tour(const TravelTable& table, bool come_back, const OrderRule& rule = {});

/// Shortest way over passable nodes from near `from` to near `to`, both ends exact; empty if there is none [m].
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> way_between(const Field<Dim, std::uint8_t>& passable, const Vec<Dim>& from, const Vec<Dim>& to);

template <int Dim>
[[nodiscard]] double length_of(std::span<const Vec<Dim>> path);

}  // namespace vantage
