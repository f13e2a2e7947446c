// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/geometry/patch.h"

namespace vantage {

/// Patches of a leaf, with the bounds of their errors, and the numbers of the sites that none of them carries.
template <int Dim>
struct CellFit {
  std::vector<Patch<Dim>> patches;
  std::vector<std::uint32_t> loose;   ///< Rising.
  std::vector<std::uint32_t> owners;  ///< In a cell of few sites: for each patch, the number of the first site of the part that hangs together.
};

}  // namespace vantage
