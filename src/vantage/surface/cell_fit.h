// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "vantage/geometry/patch.h"
#include "vantage/geometry/plane_fit.h"

namespace vantage {

/// Why the plane of a cell keeps carrying its sites: bounds of both errors with room to spare, and what the next plane follows from.
template <int Dim>
struct Standing {
  Moments<Dim> moments;
  double data = 0.0, surface = 0.0;  ///< Of the patch, without the slack [m].
};

/// Patches of a leaf, with the bounds of their errors, and the numbers of the sites that none of them carries.
template <int Dim>
struct CellFit {
  std::vector<Patch<Dim>> patches;
  std::vector<std::uint32_t> loose;         ///< Rising.
  std::vector<std::uint32_t> owners;        ///< In a cell of few sites: for each patch, the number of the first site of the part that hangs together.
  std::unique_ptr<Standing<Dim>> standing;  ///< In a large cell of one patch, if there is room to spare.
};

}  // namespace vantage
