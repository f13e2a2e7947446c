// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "vantage/geometry/hausdorff.h"

namespace vantage {
namespace {

/// A foot on the line, with what its squared distance x^2 - 2 x at + level to a place x needs.
struct LineFoot {
  double at, level;

  [[nodiscard]] double height2() const { return level - at * at; }
  [[nodiscard]] double distance2(double x) const { return (x - at) * (x - at) + std::max(0.0, height2()); }
  /// From here on `next`, which is farther right, is nearer.
  [[nodiscard]] double border(const LineFoot& next) const { return 0.5 * (next.level - level) / (next.at - at); }
};

/// The feet that are nearest to some place, from left to right: without x^2 the squared distances are lines, and this is their lower envelope.
void nearest_feet(const Feet<1>& points, std::vector<LineFoot>& feet, std::vector<LineFoot>& envelope) {
  feet.clear();
  for (std::size_t i = 0; i < points.size(); ++i) feet.push_back({points.at[0][i], points.at[0][i] * points.at[0][i] + points.height2[i]});
  std::sort(feet.begin(), feet.end(), [](const LineFoot& a, const LineFoot& b) { return a.at != b.at ? a.at < b.at : a.level < b.level; });
  envelope.clear();
  for (const LineFoot& foot : feet) {
    if (!envelope.empty() && envelope.back().at == foot.at) continue;  // The lower one is there.
    while (envelope.size() > 1 && envelope[envelope.size() - 2].border(envelope.back()) >= envelope.back().border(foot)) envelope.pop_back();
    envelope.push_back(foot);
  }
}

}  // namespace

template <>
CoverRadius<1> cover(const ConvexRegion<1>& region, const Feet<1>& points, double limit, const CoverSearch<1>& /*search*/) {
  CoverRadius<1> covering;
  if (region.count == 0) return {0.0, {}};
  if (points.size() == 0) return {std::nullopt, region.vertices[0]};
  thread_local std::vector<LineFoot> feet, envelope;
  nearest_feet(points, feet, envelope);
  const double low = std::min(region.vertices[0][0], region.vertices[region.count - 1][0]);
  const double high = std::max(region.vertices[0][0], region.vertices[region.count - 1][0]);
  double farthest2 = -1.0, place = low;
  const auto look_at = [&](const LineFoot& foot, double x) {
    if (const double d2 = foot.distance2(x); d2 > farthest2) {
      farthest2 = d2;
      place = x;
    }
  };
  double from = low;  // The foot is nearest from here to the next border; the distance is convex between.
  for (std::size_t i = 0; i < envelope.size() && from <= high; ++i) {
    const double border = i + 1 < envelope.size() ? envelope[i].border(envelope[i + 1]) : high;
    if (border < from) continue;
    look_at(envelope[i], from);
    look_at(envelope[i], std::min(border, high));
    from = border;
  }
  const double radius = std::sqrt(farthest2) * (1.0 + kCoverRounding);
  covering.farthest = ConvexRegion<1>::Place(place);
  if (radius <= limit) covering.radius = radius;
  return covering;
}

}  // namespace vantage
