// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vantage/report/pictures.h"

namespace vantage {

// Pieces that the pictures of space share.

/// Heights that leave out one in a hundred points at either end [m].
[[nodiscard]] std::pair<double, double> height_range(const ReportInput<3>& input);
/// "1.5 m"
[[nodiscard]] std::string height_text(double z);
/// The unseen over the surfaces: stronger where nothing stands before it.
[[nodiscard]] Image unseen_image(const Raster& surfaces, const Raster& unseen);
/// Height of the plan's cut: that of the lowest vantage point, so that it runs through walls even where the scanner flies [m].
[[nodiscard]] double plan_height(const ReportInput<3>& input);

/// What the pictures of the next places frame beside the contents: the places, the unseen regions that are named, and the zones, unless they lie far
/// off. Nothing without such places.
[[nodiscard]] std::vector<Box<3>> next_parts(const ReportInput<3>& input, const Box<3>& contents);

/// The places to scan from next in plan and in space, with the tour, zones, and what is unseen and why; none without such places. `box` is what the
/// pictures frame.
[[nodiscard]] std::vector<Figure> next_figures(const ReportInput<3>& input, const Box<3>& box, const Camera& bird);

}  // namespace vantage
