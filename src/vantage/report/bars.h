// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace vantage {

/// Horizontal bars of parts laid end to end; all texts are plain.
struct Bars {
  struct Part {
    std::string name, colour;  ///< A CSS colour, `var(--c1)`.
  };
  struct Row {
    std::string name;
    std::vector<double> values;  ///< One a part, >= 0.
    double mark = 0.0;           ///< A line across the bar; 0: none.
  };
  std::string title, caption;
  std::string mark;  ///< What the line means.
  std::vector<Part> parts;
  std::vector<Row> rows;
};

/// The bars as a `<figure>` with inline SVG and a legend; empty without rows.
[[nodiscard]] std::string bars_html(const Bars& bars);

}  // namespace vantage
