// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "vantage/geometry/vec.h"

namespace vantage {

/// SVG drawn over a picture, in its pixels; crisp at any size.

/// A line with a casing, so that it reads on any ground; runs shorter than a few pixels are left out.
[[nodiscard]] std::string path_overlay(std::span<const Vec<2>> path);
/// Vantage points as dots, and with their numbers where there is room; the first and the last always have theirs.
[[nodiscard]] std::string station_overlay(std::span<const Vec<2>> places, std::span<const int> numbers);
/// Diamonds for places that were used, and a cross for the next (Fig. 2 of the paper).
[[nodiscard]] std::string diamond_overlay(std::span<const Vec<2>> places);
[[nodiscard]] std::string cross_overlay(const Vec<2>& place);
/// A letter or number in a box, with a thread to its place.
[[nodiscard]] std::string tag_overlay(const Vec<2>& place, const std::string& text);
/// A bar of a round length in the lower left corner of a map.
[[nodiscard]] std::string scale_overlay(double pixels_per_metre, int width, int height);

}  // namespace vantage
