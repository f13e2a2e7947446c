// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "vantage/report/camera.h"
#include "vantage/report/canvas.h"

namespace vantage {

// Marks on pictures that stand alone as files: what overlay.h draws as SVG, in pixels.

inline constexpr Rgb kInk{29, 36, 48}, kSoftInk{90, 100, 116}, kFaintInk{228, 225, 218}, kMark{216, 27, 74}, kPlate{243, 241, 236};

/// Diamonds for places that were used, and a cross for the next (Fig. 2 of the paper).
void draw_diamond(Canvas& canvas, const Vec<2>& place, double radius);
void draw_cross(Canvas& canvas, const Vec<2>& place, double radius);
/// The way through the places with a casing.
void draw_way(Canvas& canvas, std::span<const Vec<2>> way, double width);
/// A vantage point with its number; the first is dark.
void draw_pin(Canvas& canvas, const Vec<2>& place, int number, double radius);
/// A bar of a round length with its words, its left end at `place`, at most `longest` pixels long.
void draw_scale(Canvas& canvas, const Vec<2>& place, double pixels_per_metre, double longest);

/// Where places in space are on the picture; those behind the lens are left out.
[[nodiscard]] std::vector<Vec<2>> on_canvas(std::span<const Vec<3>> places, const Camera& camera);

/// One sign of a legend and its words.
struct Key {
  enum class Sign { area, hatch, line, dashed, dot, diamond, cross, pin, ramp } sign = Sign::area;
  Rgb colour;
  std::string text;    ///< Behind the sign; of a ramp, its upper end.
  std::string before;  ///< Before the sign; of a ramp, its lower end.
  ColourMap map = ColourMap::inferno;
  double map_low = 0.0;  ///< A ramp shows [map_low, 1] of its map.
};

}  // namespace vantage
