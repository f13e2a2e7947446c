// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/report/image.h"

namespace vantage {

/// One line of a plot.
struct PlotLine {
  enum class Style { line, dashed, dots };
  Rgb colour;
  Style style = Style::line;
  std::vector<double> x{}, y{};  ///< Values that are not finite (on a logarithmic axis: not positive) are left out.
};

/// Axes and lines, drawn into pixels: a chart that stands alone as a file.
struct Plot {
  std::string title, x_label, y_label;  ///< Labels with their units.
  bool logarithmic = false;             ///< Vertical axis.
  double low = 0.0, high = 0.0;         ///< Of the vertical axis; equal: from the lines, and 0. Values beyond lie on its ends.
  double x_low = 0.0, x_high = 0.0;     ///< Of the horizontal axis; equal: from the lines.
  bool whole = true;                    ///< Whole numbers only at the horizontal axis.
  std::vector<PlotLine> lines{};
};

/// The plot on white.
[[nodiscard]] Image plot_image(const Plot& plot, int width, int height);

}  // namespace vantage
