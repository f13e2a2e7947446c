// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <utility>

#include "vantage/geometry/patch.h"
#include "vantage/report/raster.h"

namespace vantage {

inline constexpr Rgb kClay{232, 227, 216}, kWire{86, 148, 152}, kLoose{206, 160, 116}, kSection{52, 60, 76};

enum class Colours { by_kind, clay };

/// What is drawn of the patches, and how.
struct ModelView {
  Box<3> domain;                       ///< Patches that do not meet it are left out [m].
  std::pair<double, double> heights;   ///< Single points and thin pieces are darker at the lower, lighter at the upper [m].
  Colours colours = Colours::by_kind;  ///< Single points and thin pieces in colours of their own, or in clay too.
};

/// Draws the patches as a clay model.
void draw_patches(Raster& raster, std::span<const Patch<3>> patches, const ModelView& view);

/// Where a plan is cut.
struct PlanCut {
  double height = 0.0;  ///< [m]
  double reach = 0.0;   ///< Single points and thin pieces so near to it count as cut [m].
};

/// Draws an architect's plan: what lies below the cut, walls by their edges, and dark what is cut.
void draw_plan(Raster& raster, std::span<const Patch<3>> patches, const ModelView& view, const PlanCut& cut);

}  // namespace vantage
