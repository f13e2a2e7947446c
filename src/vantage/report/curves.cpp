// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr double kWidth = 520.0, kHeight = 300.0;
constexpr double kLeft = 58.0, kRight = 96.0, kTop = 14.0, kBottom = 46.0;

/// From values to the pixels of the chart.
struct Axes {
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  bool logarithmic = false;
  std::vector<double> x_ticks, y_ticks;

  [[nodiscard]] double scaled(double y) const { return logarithmic ? log10_of(y) : y; }
  [[nodiscard]] double px(double x) const { return kLeft + (x - x_low) / (x_high - x_low) * (kWidth - kLeft - kRight); }
  [[nodiscard]] double py(double y) const {
    const double t = (scaled(y) - scaled(y_low)) / (scaled(y_high) - scaled(y_low));
    return kHeight - kBottom - std::clamp(t, 0.0, 1.0) * (kHeight - kTop - kBottom);
  }
};

bool shown(const Chart& chart, const Curve& curve, std::size_t i) {
  return std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) && (!chart.logarithmic || curve.y[i] > 0.0);
}

/// Powers of ten around [low, high].
std::vector<double> decades(double low, double high) {
  std::vector<double> ticks{1.0};
  while (ticks.front() > low && ticks.front() > 1e-12) ticks.insert(ticks.begin(), ticks.front() / 10.0);
  while (ticks.back() < high && ticks.back() < 1e15) ticks.push_back(ticks.back() * 10.0);
  while (ticks.size() > 2 && ticks[1] <= low) ticks.erase(ticks.begin());
  while (ticks.size() > 2 && ticks[ticks.size() - 2] >= high) ticks.pop_back();
  return ticks;
}

/// Axes around all that is shown; nullopt when nothing is.
bool fit(const Chart& chart, Axes& axes) {
  double x_low = 1e300, x_high = -1e300, y_low = 1e300, y_high = -1e300;
  for (const Curve& curve : chart.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!shown(chart, curve, i)) continue;
      x_low = std::min(x_low, curve.x[i]);
      x_high = std::max(x_high, curve.x[i]);
      y_low = std::min(y_low, curve.y[i]);
      y_high = std::max(y_high, curve.y[i]);
    }
  }
  if (x_low > x_high) return false;
  axes.logarithmic = chart.logarithmic;
  axes.x_low = x_low;
  axes.x_high = std::max(x_high, x_low + 1.0);
  for (const double tick : round_ticks(axes.x_low, axes.x_high, 6)) {
    if (tick >= axes.x_low && tick <= axes.x_high && tick == std::floor(tick)) axes.x_ticks.push_back(tick);
  }
  if (chart.logarithmic) {
    axes.y_ticks = decades(y_low, y_high);
  } else if (chart.high > chart.low) {
    axes.y_ticks = round_ticks(chart.low, chart.high, 4);
  } else {
    axes.y_ticks = round_ticks(std::min(y_low, 0.0), y_high > 0.0 ? y_high : 1.0, 4);
  }
  axes.y_low = axes.y_ticks.front();
  axes.y_high = axes.y_ticks.back();
  return true;
}

std::string grid(const Chart& chart, const Axes& axes) {
  std::string svg;
  if (chart.band_high > chart.band_low) {
    const double top = axes.py(chart.band_high), bottom = std::max(axes.py(chart.band_low), top + 1.0);
    svg += fmt::format(R"(<rect class="band" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)", kLeft, top, kWidth - kLeft - kRight,
                       bottom - top);
  }
  // Many decades: a label at every second or third.
  const std::size_t skip = (axes.y_ticks.size() + 5) / 6;
  for (std::size_t i = 0; i < axes.y_ticks.size(); i += skip) {
    const double y = axes.py(axes.y_ticks[i]);
    svg += fmt::format(R"(<path class="grid" d="M{:.1f} {:.1f}H{:.1f}"/>)", kLeft, y, kWidth - kRight);
    svg +=
        fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}" dy=".35em" text-anchor="end">{}</text>)", kLeft - 8.0, y, rounded(axes.y_ticks[i]));
  }
  for (const double tick : axes.x_ticks) {
    const double x = axes.px(tick);
    svg += fmt::format(R"(<path class="axis" d="M{0:.1f} {1:.1f}v5"/><text class="tick" x="{0:.1f}" y="{2:.1f}" text-anchor="middle">{3}</text>)", x,
                       kHeight - kBottom, kHeight - kBottom + 20.0, rounded(tick));
  }
  svg += fmt::format(R"(<path class="axis" d="M{:.1f} {:.1f}H{:.1f}"/>)", kLeft, kHeight - kBottom, kWidth - kRight);
  svg += fmt::format(R"(<text class="label" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)", 0.5 * (kLeft + kWidth - kRight), kHeight - 6.0,
                     escaped(chart.x_label));
  return svg;
}

std::string drawn(const Chart& chart, const Curve& curve, const Axes& axes) {
  std::string line, dots;
  double first = kLeft, last = kLeft;
  const bool sparse = curve.x.size() <= 60 && axes.x_high - axes.x_low <= 60.0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!shown(chart, curve, i)) continue;
    const double x = axes.px(curve.x[i]), y = axes.py(curve.y[i]);
    if (line.empty()) first = x;
    last = x;
    line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x, y);
    dots += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}"><title>{} {}: {}</title></circle>)", x, y, sparse ? "3" : "2",
                        escaped(chart.x_label), rounded(curve.x[i]), escaped(quantity(curve.y[i], chart.unit)));
  }
  if (line.empty()) return {};
  const bool dashed = curve.style == Curve::Style::dashed;
  std::string svg = fmt::format(R"(<g class="curve{}{}" style="--c:{}">)", dashed ? " dashed" : "", sparse ? "" : " dense", curve.colour);
  if (curve.style == Curve::Style::area) {
    svg += fmt::format(R"(<path class="under" d="{}L{:.1f} {:.1f}H{:.1f}Z"/>)", line, last, kHeight - kBottom, first);
  }
  if (curve.style != Curve::Style::dots) svg += "<path d=\"" + line + "\"/>";
  return svg + dots + "</g>";
}

/// Names at the ends of the curves, kept apart.
std::string labels(const Chart& chart, const Axes& axes) {
  struct Label {
    double y;
    const Curve* curve;
  };
  std::vector<Label> all;
  for (const Curve& curve : chart.curves) {
    for (std::size_t i = curve.x.size(); i-- > 0;) {
      if (!shown(chart, curve, i)) continue;
      if (!curve.name.empty()) all.push_back({axes.py(curve.y[i]), &curve});
      break;
    }
  }
  std::ranges::stable_sort(all, [](const Label& a, const Label& b) { return a.y < b.y; });
  constexpr double kLine = 17.0;
  for (std::size_t i = 1; i < all.size(); ++i) all[i].y = std::max(all[i].y, all[i - 1].y + kLine);
  double lowest = kHeight - kBottom;
  for (std::size_t i = all.size(); i-- > 0 && all[i].y > lowest; lowest -= kLine) all[i].y = lowest;  // Back up from below the axis.
  std::string svg;
  for (const Label& label : all) {
    svg += fmt::format(R"(<text class="name" style="--c:{}" x="{:.1f}" y="{:.1f}" dy=".35em">{}</text>)", label.curve->colour, kWidth - kRight + 10.0,
                       label.y, escaped(label.curve->name));
  }
  return svg;
}

}  // namespace

std::string chart_html(const Chart& chart) {
  Axes axes;
  if (!fit(chart, axes)) return {};
  std::string curves;
  for (const Curve& curve : chart.curves) curves += drawn(chart, curve, axes);
  const std::string unit = chart.unit.empty() ? std::string() : " [" + chart.unit + "]";
  return fmt::format(
      "<figure class=\"chart\"><h3>{0}<small>{1}</small></h3>"
      "<svg viewBox=\"0 0 {2} {3}\" role=\"img\" aria-label=\"{0}\">{4}{5}{6}</svg><figcaption>{7}</figcaption></figure>\n",
      escaped(chart.title), escaped(unit), kWidth, kHeight, grid(chart, axes), curves, labels(chart, axes), escaped(chart.caption));
}

std::vector<double> round_ticks(double low, double high, int count) {
  const double least = std::max((high - low) / std::max(count, 1), 1e-9) * 0.999;
  // Steps below one are kept as their inverse, a whole number, so that 3 * 0.1 stays 0.3.
  double step = 1.0, parts = 1.0;
  for (int k = 0; step < least && k < 60; ++k) step *= k % 3 == 1 ? 2.5 : 2.0;
  if (least < 1.0) {
    for (int k = 0; k < 60 && 1.0 / (parts * (k % 3 == 1 ? 2.5 : 2.0)) >= least; ++k) parts *= k % 3 == 1 ? 2.5 : 2.0;
  }
  std::vector<double> ticks;
  const double first = std::floor(low / step * parts + 1e-9), last = std::max(std::ceil(high / step * parts - 1e-9), first + 1.0);
  const int steps = static_cast<int>(std::min(last - first, 1000.0));
  for (int i = 0; i <= steps; ++i) ticks.push_back((first + i) * step / parts);
  return ticks;
}

double log10_of(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  const double z = (mantissa - 1.0) / (mantissa + 1.0);
  double sum = 0.0;
  for (int k = 20; k >= 0; --k) sum = sum * z * z + 1.0 / (2.0 * k + 1.0);
  return 2.0 * z * sum * 0.43429448190325183 + exponent * 0.30102999566398120;
}

}  // namespace vantage
