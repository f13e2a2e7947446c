// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace vantage {

/// One line of a chart.
struct Curve {
  enum class Style { line, dots, area, dashed };
  std::string name;    ///< Written at its end; empty: no label.
  std::string colour;  ///< A CSS colour, `var(--c1)`.
  Style style = Style::line;
  std::vector<double> x, y;  ///< Values that are not finite (on a logarithmic axis: not positive) are left out.
};

/// Axes and curves; all texts are plain.
struct Chart {
  std::string title, caption;
  std::string x_label, unit;               ///< `unit` stands at the numbers of the vertical axis.
  bool logarithmic = false;                ///< Vertical axis.
  double low = 0.0, high = 0.0;            ///< Of the vertical axis; equal: from the curves, and 0.
  double band_low = 0.0, band_high = 0.0;  ///< A shaded range of y; equal: none.
  std::vector<Curve> curves;
};

/// The chart as a `<figure>` with inline SVG; empty if no curve has a point.
[[nodiscard]] std::string chart_html(const Chart& chart);

/// Steps of 1, 2 or 5 times a power of ten that cover [low, high] in about `count` parts.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int count);
/// Logarithm to base 10 by + - * / only, of a positive number.
[[nodiscard]] double log10_of(double value);

}  // namespace vantage
