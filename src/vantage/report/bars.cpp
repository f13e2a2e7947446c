// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "vantage/report/figure.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr double kWidth = 520.0, kLeft = 96.0, kRight = 56.0, kRow = 26.0, kBar = 16.0;

double sum_of(const Bars::Row& row) { return std::accumulate(row.values.begin(), row.values.end(), 0.0); }

std::string row_svg(const Bars& bars, const Bars::Row& row, double y, double scale) {
  std::string svg = fmt::format(R"(<text x="{:.1f}" y="{:.1f}" dy=".35em" text-anchor="end">{}</text>)", kLeft - 10.0, y, escaped(row.name));
  double x = kLeft;
  for (std::size_t p = 0; p < bars.parts.size() && p < row.values.size(); ++p) {
    const double width = row.values[p] * scale;
    svg += fmt::format(R"(<rect style="--c:{}" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{}"><title>{}: {}</title></rect>)", bars.parts[p].colour,
                       x, y - 0.5 * kBar, width, kBar, escaped(bars.parts[p].name), number(row.values[p]));
    x += width;
  }
  svg += fmt::format(R"(<text class="soft" x="{:.1f}" y="{:.1f}" dy=".35em">{}</text>)", x + 7.0, y, number(sum_of(row)));
  if (row.mark > 0.0) svg += fmt::format(R"(<path d="M{:.1f} {:.1f}v{:.1f}"/>)", kLeft + row.mark * scale, y - 0.5 * kRow, kRow);
  return svg;
}

}  // namespace

std::string bars_html(const Bars& bars) {
  if (bars.rows.empty()) return {};
  double most = 1e-9;
  for (const Bars::Row& row : bars.rows) most = std::max({most, sum_of(row), row.mark});
  const double scale = (kWidth - kLeft - kRight) / most;
  std::string svg, legend;
  for (std::size_t i = 0; i < bars.rows.size(); ++i) svg += row_svg(bars, bars.rows[i], kRow * (static_cast<double>(i) + 0.5), scale);
  for (const Bars::Part& part : bars.parts) legend += legend_entry("area", part.colour, part.name);
  if (!bars.mark.empty()) legend += legend_entry("line", "var(--ink)", bars.mark);
  return fmt::format(
      "<figure class=\"chart\"><h3>{0}</h3><svg class=\"bars\" viewBox=\"0 0 {1} {2}\" role=\"img\" aria-label=\"{0}\">{3}</svg>"
      "<figcaption>{4}<div class=\"legend\">{5}</div></figcaption></figure>\n",
      escaped(bars.title), kWidth, kRow * static_cast<double>(bars.rows.size()), svg, escaped(bars.caption), legend);
}

}  // namespace vantage
