// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/report/image.h"

namespace vantage {

/// One picture: pixels, what lies over them as SVG in the same pixels, and the words for those who cannot see it.
struct Panel {
  Image image;
  std::string overlay;  ///< SVG elements.
  std::string alt;      ///< Plain text.
  std::string caption;  ///< Plain text under a panel of several; empty for a picture that stands alone.
};

/// One or several pictures under one title. Texts are plain and are escaped when written; `legend` is HTML.
struct Figure {
  std::string id;       ///< Anchor.
  std::string title;
  std::string caption;  ///< What is to be seen, in a sentence.
  std::string legend;
  std::vector<Panel> panels;
};

/// A swatch and its word; `kind` is a class of the page's style (`dot`, `line`, `area`, `hatch`, `cross`, `diamond`).
[[nodiscard]] std::string legend_entry(const std::string& kind, const std::string& colour, const std::string& text);
/// A colour bar with the words at its ends.
[[nodiscard]] std::string legend_bar(const std::string& gradient, const std::string& low, const std::string& high);

}  // namespace vantage
