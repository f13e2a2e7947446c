// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/report/curves.h"
#include "vantage/report/marks.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr Rgb kWhite{255, 255, 255};
constexpr double kLeft = 86.0, kRight = 22.0, kTop = 44.0, kBottom = 66.0, kTick = 17.0, kLabel = 18.0, kTitle = 21.0;

struct Frame {
  double width, height;
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  bool logarithmic = false;
  std::vector<double> x_ticks{}, y_ticks{};

  [[nodiscard]] double scaled(double y) const { return logarithmic ? log10_of(y) : y; }
  [[nodiscard]] Vec<2> at(double x, double y) const {
    const double s = (x - x_low) / (x_high - x_low), t = (scaled(y) - scaled(y_low)) / (scaled(y_high) - scaled(y_low));
    return {kLeft + s * (width - kLeft - kRight), height - kBottom - std::clamp(t, 0.0, 1.0) * (height - kTop - kBottom)};
  }
};

bool shown(const Plot& plot, const PlotLine& line, std::size_t i) {
  return std::isfinite(line.x[i]) && std::isfinite(line.y[i]) && (!plot.logarithmic || line.y[i] > 0.0);
}

/// The smallest powers of ten around [low, high].
std::vector<double> powers(double low, double high) {
  double tick = 1.0;
  for (int k = 0; k < 15 && tick > low; ++k) tick /= 10.0;
  for (int k = 0; k < 15 && tick * 10.0 <= low; ++k) tick *= 10.0;
  std::vector<double> ticks{tick};
  while (ticks.back() < high && ticks.size() < 30) ticks.push_back(ticks.back() * 10.0);
  if (ticks.size() == 1) ticks.push_back(tick * 10.0);
  return ticks;
}

Frame fitted(const Plot& plot, double width, double height) {
  double x_low = 1e300, x_high = -1e300, y_low = 1e300, y_high = -1e300;
  for (const PlotLine& line : plot.lines) {
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      if (!shown(plot, line, i)) continue;
      x_low = std::min(x_low, line.x[i]);
      x_high = std::max(x_high, line.x[i]);
      y_low = std::min(y_low, line.y[i]);
      y_high = std::max(y_high, line.y[i]);
    }
  }
  if (x_low > x_high) x_low = y_low = 0.0, x_high = y_high = 1.0;
  if (plot.x_high > plot.x_low) x_low = plot.x_low, x_high = plot.x_high;
  Frame frame{width, height, x_low, std::max(x_high, x_low + 1.0)};
  frame.logarithmic = plot.logarithmic;
  for (const double tick : round_ticks(frame.x_low, frame.x_high, 8))
    if (tick >= frame.x_low - 1e-9 && tick <= frame.x_high + 1e-9 && (!plot.whole || tick == std::floor(tick))) frame.x_ticks.push_back(tick);
  if (plot.logarithmic)
    frame.y_ticks = powers(plot.high > plot.low ? plot.low : y_low, plot.high > plot.low ? plot.high : y_high);
  else if (plot.high > plot.low)
    frame.y_ticks = round_ticks(plot.low, plot.high, 5);
  else
    frame.y_ticks = round_ticks(std::min(y_low, 0.0), y_high > 0.0 ? y_high : 1.0, 5);
  frame.y_low = frame.y_ticks.front();
  frame.y_high = frame.y_ticks.back();
  if (plot.logarithmic && plot.high > plot.low) {
    frame.y_low = plot.low;
    frame.y_high = plot.high;
    std::erase_if(frame.y_ticks, [&](double tick) { return tick < plot.low || tick > plot.high; });
  }
  return frame;
}

void draw_axes(Canvas& canvas, const Plot& plot, const Frame& frame) {
  const auto line = [&](const Vec<2>& a, const Vec<2>& b, double width, Rgb colour) { canvas.stroke(std::array<Vec<2>, 2>{a, b}, width, colour); };
  for (const double tick : frame.y_ticks) {
    const Vec<2> left = frame.at(frame.x_low, tick), right = frame.at(frame.x_high, tick);
    line(left, right, 1.0, kFaintInk);
    canvas.text(left + Vec<2>(-10.0, 0.34 * kTick), rounded(tick), {kTick, kSoftInk, Lettering::Align::right});
  }
  for (const double tick : frame.x_ticks) {
    const Vec<2> foot = frame.at(tick, frame.y_low);
    line(foot, foot + Vec<2>(0.0, 6.0), 1.2, kSoftInk);
    canvas.text(foot + Vec<2>(0.0, 24.0), rounded(tick), {kTick, kSoftInk, Lettering::Align::middle});
  }
  line(frame.at(frame.x_low, frame.y_low), frame.at(frame.x_high, frame.y_low), 1.4, kSoftInk);
  const double middle = 0.5 * (kTop + frame.height - kBottom);
  canvas.text({0.5 * (kLeft + frame.width - kRight), frame.height - 14.0}, plot.x_label, {kLabel, kInk, Lettering::Align::middle});
  canvas.text({20.0, middle}, plot.y_label, {kLabel, kInk, Lettering::Align::middle, false, true});
  canvas.text({kLeft, 24.0}, plot.title, {kTitle, kInk, Lettering::Align::left, true});
}

void draw_line(Canvas& canvas, const Plot& plot, const PlotLine& line, const Frame& frame) {
  std::vector<Vec<2>> places;
  for (std::size_t i = 0; i < line.x.size(); ++i)
    if (shown(plot, line, i)) places.push_back(frame.at(line.x[i], line.y[i]));
  if (line.style == PlotLine::Style::dashed) return canvas.dashes(places, 2.0, 8.0, line.colour);
  const std::span<const Vec<2>> all(places);
  if (line.style == PlotLine::Style::line)
    for (std::size_t i = 1; i < all.size(); ++i) canvas.stroke(all.subspan(i - 1, 2), 2.4, line.colour);
  if (line.style == PlotLine::Style::line && places.size() > 80) return;
  for (std::size_t i = 0; i < all.size(); ++i) {
    canvas.stroke(all.subspan(i, 1), 9.5, kWhite);
    canvas.stroke(all.subspan(i, 1), 7.0, line.colour);
  }
}

}  // namespace

Image plot_image(const Plot& plot, int width, int height) {
  const Frame frame = fitted(plot, width, height);
  Canvas canvas(width, height, kWhite);
  draw_axes(canvas, plot, frame);
  for (const PlotLine& line : plot.lines) draw_line(canvas, plot, line, frame);
  return canvas.image();
}

}  // namespace vantage
