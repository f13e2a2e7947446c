// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>

#include "vantage/geometry/vec.h"
#include "vantage/report/image.h"

namespace vantage {

/// How text is set. `size` is the height of a line's letters with descenders, about 1.4 times that of a capital [pixels].
struct Lettering {
  enum class Align { left, middle, right };
  double size = 20.0;
  Rgb colour{29, 36, 48};
  Align align = Align::left;
  bool bold = false;
  bool upwards = false;  ///< Turned by a quarter, reading from below.
};

/// Draws smooth strokes, areas and text into an image; places are in pixels from the upper left corner. For pictures that stand alone as files, where
/// no SVG can lie over them.
class Canvas {
 public:
  Canvas(int width, int height, Rgb ground);
  explicit Canvas(Image image) : image_(std::move(image)) {}

  /// A polyline with round ends and joints; one place gives a disc.
  void stroke(std::span<const Vec<2>> line, double width, Rgb colour, double opacity = 1.0);
  /// The same in dashes of `dash` and gaps of half of it.
  void dashes(std::span<const Vec<2>> line, double width, double dash, Rgb colour);
  /// A simple polygon.
  void area(std::span<const Vec<2>> corners, Rgb colour, double opacity = 1.0);
  void rectangle(const Vec<2>& low, const Vec<2>& high, Rgb colour, double opacity = 1.0);
  /// Lays `picture` over what is there, its upper left corner at a pixel; what stands out is cut.
  void lay(const Image& picture, int x, int y);
  /// Text on a baseline that begins, is centred or ends at `at`; UTF-8; unknown characters are boxes.
  void text(const Vec<2>& at, std::string_view text, const Lettering& lettering = {});

  [[nodiscard]] const Image& image() const { return image_; }

 private:
  /// Mixes colour into the pixels of a box by a cover of [0, 1] at the pixel's centre.
  template <class Cover>
  void mix_in(const Vec<2>& low, const Vec<2>& high, Rgb colour, const Cover& cover);

  Image image_;
};

/// [pixels]
[[nodiscard]] double text_width(std::string_view text, const Lettering& lettering = {});

/// A letter as strokes in units of a twentieth of the lettering's size, y up from the baseline.
struct Glyph {
  double width = 0.0;                        ///< Of its strokes.
  std::vector<std::vector<Vec<2>>> strokes;  ///< Curves are broken into short pieces.
};
/// Of the project's own single-stroke alphabet.
[[nodiscard]] const Glyph& glyph(char32_t code);

}  // namespace vantage
