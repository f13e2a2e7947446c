// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "vantage/exchange/leaves.h"

namespace vantage {

/// Leaves as few bytes: the tree of their cells, level by level from one root of 2^31 cells a side. Each cell says whether it is a plane (and
/// which: its difference to what a plane nearby predicts), or which of its children hold something; the smallest say which of their sites are
/// there. Every bit is predicted from the cells around it (predictor.h). The order of the leaves does not matter, and no two planes or two sites may
/// share a cell. Throws bad_input for a plane or site outside the lattice.
template <int Dim>
[[nodiscard]] std::string encode_leaves(const Leaves<Dim>& leaves);

/// How many leaves a code holds: the reader stops, with an error, where there are more.
struct LeafCounts {
  std::size_t planes = 0;
  std::size_t cells = 0;  ///< With sites.
};

/// The leaves again, in the order of `Leaves`. Throws bad_input if `bytes` are not the code of so many leaves; memory follows what was read, not
/// what the counts promise.
template <int Dim>
[[nodiscard]] Leaves<Dim> decode_leaves(std::string_view bytes, const LeafCounts& counts, std::string_view where);

/// Puts leaves into the order of `Leaves`.
template <int Dim>
void sort_leaves(Leaves<Dim>& leaves);

}  // namespace vantage
