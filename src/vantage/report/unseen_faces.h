// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/field/field.h"
#include "vantage/report/raster.h"

namespace vantage {

inline constexpr Rgb kUnseenColour{99, 91, 245};

/// Draws the lattice faces between unseen and seen nodes, lighter from above; the faces of the domain itself are left out, or they would hide all.
/// `lids`: also those below unseen nodes; from above, such as of the sky over clouds of hits alone, they hide all else.
void draw_unseen(Raster& raster, const Field<3, NodeState>& state, bool lids = true);

}  // namespace vantage
