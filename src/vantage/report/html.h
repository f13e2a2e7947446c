// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/report/figure.h"

namespace vantage {

/// The page: well-formed as XML too, styled for light, dark, narrow and printed; `body` is HTML.
[[nodiscard]] std::string page(const std::string& title, const std::string& body);
/// The style sheet of the page.
[[nodiscard]] std::string style_sheet();

/// Figures with their pictures as data URIs; the pictures are encoded in parallel.
[[nodiscard]] std::string figures_html(const std::vector<Figure>& figures);

/// A table with a header row; cells are HTML. Columns whose name starts with `>` are numbers, set to the right.
[[nodiscard]] std::string table(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows);
/// A closed block that opens by a click.
[[nodiscard]] std::string details(const std::string& summary, const std::string& content);

}  // namespace vantage
