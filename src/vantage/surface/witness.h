// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <span>

#include "vantage/surface/snap.h"

namespace vantage {

/// Proof that no two flats carry a cell's points, whatever else is added: 2 Dim + 1 sites of which every Dim + 1 span a simplex wider than
/// twice the tolerance. (One of two planes would carry Dim + 1 of them.)
template <int Dim>
struct Witness {
  static constexpr int kCount = 2 * Dim + 1;
  std::array<Site<Dim>, kCount> sites;
};

/// Looks for a witness among a sample of the sites, which are in Morton order; `tolerance` is in steps of the lattice. May miss one that exists.
template <int Dim>
[[nodiscard]] std::optional<Witness<Dim>> find_witness(std::span<const Site<Dim>> sites, double tolerance);

/// Least distance between two parallel planes (lines) with the simplex between them.
template <int Dim>
[[nodiscard]] double width(const std::array<Vec<Dim>, Dim + 1>& simplex);

}  // namespace vantage
