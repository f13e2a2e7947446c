// SPDX-License-Identifier: Apache-2.0
#include "vantage/scan/confirm.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr int kReach = 2;                // Rays to each side.
constexpr int kNeeded[] = {0, 0, 1, 3};  // Hits at a like range, of 4 or 24 rays around, by dimension.
/// Difference of ranges, in distances between rays; in space some rays around are as far on any wall.
constexpr double kSlant[] = {0.0, 0.0, 10.0, 4.0};
constexpr double kDeviations = 4.0;  // The same, in standard deviations of the noise.

}  // namespace

template <int Dim>
std::int64_t drop_unconfirmed(Scan<Dim>& scan, double noise) {
  const int columns = scan.pattern.columns(), rows = scan.pattern.template rows<Dim>();
  const bool around = scan.pattern.full_circle();
  const auto confirmed = [&](int c, int r, double range) {
    const double most = std::max(kSlant[Dim] * scan.pattern.step * range, kDeviations * noise);
    int like = 0;
    for (int dc = -kReach; dc <= kReach; ++dc)
      for (int dr = std::max(-kReach, -r); dr <= std::min(kReach, rows - 1 - r); ++dr) {
        const int column = around ? (c + dc + columns) % columns : c + dc;
        if ((dc == 0 && dr == 0) || column < 0 || column >= columns) continue;
        like += std::abs(static_cast<double>(scan.range(column, r + dr)) - range) <= most ? 1 : 0;  // Not so for infinity and NaN.
      }
    return like >= kNeeded[Dim];
  };
  std::vector<std::size_t> alone;
  for (int c = 0; c < columns; ++c)
    for (int r = 0; r < rows; ++r)
      if (const float range = scan.range(c, r); std::isfinite(range) && !confirmed(c, r, static_cast<double>(range)))
        alone.push_back(static_cast<std::size_t>(c * rows + r));
  for (const std::size_t i : alone) scan.ranges[i] = kNoData;
  return static_cast<std::int64_t>(alone.size());
}

template std::int64_t drop_unconfirmed<2>(Scan<2>&, double);
template std::int64_t drop_unconfirmed<3>(Scan<3>&, double);

}  // namespace vantage
