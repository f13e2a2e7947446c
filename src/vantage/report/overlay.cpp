// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/overlay.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr double kShortestRun = 2.5;  ///< Of a path [pixels].
constexpr double kTagHeight = 49.0;   ///< Of a tag above its place; nearer to the picture's upper edge it hangs below [pixels].

/// Places that keep `gap` from each other, the last and the first before all others.
std::vector<bool> spread(std::span<const Vec<2>> places, double gap) {
  std::vector<bool> kept(places.size(), false);
  std::vector<std::size_t> order;
  order.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) order.push_back(i == 0 ? places.size() - 1 : i - 1);
  std::vector<Vec<2>> taken;
  for (const std::size_t i : order) {
    const auto near = [&](const Vec<2>& other) { return (other - places[i]).norm() < gap; };
    if (std::ranges::any_of(taken, near)) continue;
    kept[i] = true;
    taken.push_back(places[i]);
  }
  return kept;
}

/// 1, 2 or 5 times a power of ten, at most `limit`.
double round_length(double limit) {
  double length = 1e-3;
  for (int k = 0; k < 24; ++k) {
    const double next = length * (k % 3 == 1 ? 2.5 : 2.0);
    if (next > limit) break;
    length = next;
  }
  return length;
}

}  // namespace

std::string path_overlay(std::span<const Vec<2>> path) {
  std::string d;
  Vec<2> last = Vec<2>::Zero();
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0 && i + 1 < path.size() && (path[i] - last).norm() < kShortestRun) continue;
    d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", path[i].x(), path[i].y());
    last = path[i];
  }
  if (d.empty()) return {};
  return fmt::format(R"(<path class="way casing" d="{0}"/><path class="way" d="{0}"/>)", d);
}

std::string station_overlay(std::span<const Vec<2>> places, std::span<const int> numbers) {
  const std::vector<bool> pinned = spread(places, 25.0), major = spread(places, 70.0);
  std::string dots, pins;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string at = fmt::format(R"(cx="{:.1f}" cy="{:.1f}")", places[i].x(), places[i].y());
    dots += fmt::format(R"(<circle class="dot" {} r="5"/>)", at);
    if (!pinned[i]) continue;
    pins += fmt::format(R"(<g class="pin{}{}"><circle {} r="12"/><text x="{:.1f}" y="{:.1f}" dy=".35em">{}</text></g>)", major[i] ? " major" : "",
                        i == 0 ? " first" : "", at, places[i].x(), places[i].y(), numbers[i]);
  }
  return dots + pins;
}

std::string diamond_overlay(std::span<const Vec<2>> places) {
  std::string d;
  for (const Vec<2>& p : places) d += fmt::format("M{:.1f} {:.1f}l9 9l-9 9l-9 -9Z", p.x(), p.y() - 9.0);
  return d.empty() ? std::string() : R"(<path class="diamond" d=")" + d + "\"/>";
}

std::string cross_overlay(const Vec<2>& place) {
  const std::string d = fmt::format("M{:.1f} {:.1f}l24 24m0 -24l-24 24", place.x() - 12.0, place.y() - 12.0);
  return fmt::format(R"(<path class="cross casing" d="{0}"/><path class="cross" d="{0}"/>)", d);
}

std::string tag_overlay(const Vec<2>& place, const std::string& text) {
  const double width = 16.0 + 9.0 * static_cast<double>(text.size());
  const bool below = place.y() < kTagHeight;
  return fmt::format(
      "<g class=\"tag{7}\"><path d=\"M{0:.1f} {1:.1f}v{8}26\"/><circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"3\"/>"
      "<rect x=\"{2:.1f}\" y=\"{3:.1f}\" width=\"{4:.1f}\" height=\"24\" rx=\"6\"/><text x=\"{0:.1f}\" y=\"{5:.1f}\" dy=\".35em\">{6}</text></g>",
      place.x(), place.y(), place.x() - 0.5 * width, place.y() + (below ? 24.0 : -48.0), width, place.y() + (below ? 36.0 : -36.0), escaped(text),
      below ? " below" : "", below ? "" : "-");
}

std::string scale_overlay(double pixels_per_metre, int width, int height) {
  const double length = round_length(0.2 * width / pixels_per_metre);
  const double x = 56.0, y = height - 56.0, end = x + length * pixels_per_metre;
  const std::string d = fmt::format("M{0:.1f} {2:.1f}v8H{1:.1f}v-8", x, end, y - 8.0);
  return fmt::format(R"(<g class="scale"><path class="casing" d="{0}"/><path d="{0}"/><text x="{1:.1f}" y="{2:.1f}">{3}</text></g>)", d,
                     0.5 * (x + end), y - 9.0, rounded(length) + "\u00a0m");
}

}  // namespace vantage
