// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/geometry/patch.h"
#include "vantage/report/raster.h"

namespace vantage {

inline constexpr Rgb kClay{232, 227, 216}, kWire{14, 148, 160}, kLoose{234, 120, 40}, kSection{52, 60, 76};

enum class Colours { by_kind, clay };

/// Draws the patches that meet `domain` as a clay model; thin pieces and single points in colours of their own, or in clay too.
void draw_patches(Raster& raster, std::span<const Patch<3>> patches, const Box<3>& domain, Colours colours);

/// Draws an architect's plan: what lies below the height `cut`, walls by their edges, and dark where the cut runs through a patch.
void draw_plan(Raster& raster, std::span<const Patch<3>> patches, const Box<3>& domain, double cut);

}  // namespace vantage
