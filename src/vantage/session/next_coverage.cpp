// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"
#include "vantage/session/next_notes.h"

namespace vantage {
namespace {

constexpr int kFew = 3;  // Fewer rays of a row are strays, as where the image was made (bin_points.h).

/// Whether rows of the image say something, and whether it is more than hits.
struct Rows {
  int lowest = 0, highest = -1, highest_hit = -1;
  bool empty = false;  ///< Some rays met nothing.
};

Rows rows_of(const Scan<3>& scan) {
  const int columns = scan.pattern.columns(), rows = scan.pattern.rows<3>();
  Rows found{rows};
  for (int r = 0; r < rows; ++r) {
    int hits = 0, all = 0;
    for (int c = 0; c < columns; ++c) {
      const float range = scan.range(c, r);
      all += std::isnan(range) ? 0 : 1;
      hits += std::isfinite(range) ? 1 : 0;
      found.empty = found.empty || std::isinf(range);
    }
    if (all >= kFew) found.lowest = std::min(found.lowest, r), found.highest = r;
    if (hits >= kFew) found.highest_hit = r;
  }
  return found;
}

/// The sines of the outermost rays, half a step farther: so wide is a ray.
Elevations coverage_of(const Scan<3>& scan) {
  const Rows rows = rows_of(scan);
  if (rows.highest < 0) return {};
  const ScanPattern& pattern = scan.pattern;
  const double low = std::max(pattern.elevation(rows.lowest) - 0.5 * pattern.step, -0.5 * kPi);
  const double high = std::min(pattern.elevation(rows.highest) + 0.5 * pattern.step, 0.5 * kPi);
  Elevations coverage{1.0, -1.0, rows.highest == rows.highest_hit, !rows.empty};
  for (int c = 0; c < pattern.columns(); ++c) {
    const auto [sine, cosine] = sin_cos(pattern.azimuth(c));
    for (const double elevation : {low, high}) {  // A scanner that stands at a slant sees higher on one side.
      const auto [up, flat] = sin_cos(elevation);
      const double z = (scan.world_from_sensor * Vec<3>(flat * cosine, flat * sine, up)).z();
      coverage.lowest = std::min(coverage.lowest, z);
      coverage.highest = std::max(coverage.highest, z);
    }
  }
  // What spans all but the scanner's own foot and zenith spans all.
  if (pattern.elevation(rows.lowest) - pattern.step <= -0.5 * kPi) coverage.lowest = -1.0;
  if (pattern.elevation(rows.highest) + pattern.step >= 0.5 * kPi) coverage.highest = 1.0;
  return coverage;
}

double elevation_deg(double sine) { return degrees(angle_of(sine, std::sqrt(std::max(0.0, 1.0 - sine * sine)))); }

}  // namespace

ScanCoverage::ScanCoverage(int count, const std::function<Scan<3>(int)>& scan) : all{1.0, -1.0, true, true} {
  for (int k = 0; k < count; ++k) {
    const Scan<3> one = scan(k);
    of_scan.push_back(coverage_of(one));
    from.push_back(one.origin);
    all.lowest = std::min(all.lowest, of_scan.back().lowest);
    all.highest = std::max(all.highest, of_scan.back().highest);
    all.by_hits = all.by_hits && of_scan.back().by_hits;
    all.each_way = all.each_way && of_scan.back().each_way;
  }
}

std::optional<Elevations> ScanCoverage::limits() const {
  if (all.lowest <= -1.0 && all.highest >= 1.0 && !all.by_hits) return std::nullopt;
  return all;
}

double ScanCoverage::beyond(const BeliefView<3>& view) const {
  const Grid<3>& grid = view.window();
  const auto missed = [&](const Vec<3>& p) {
    for (std::size_t k = 0; k < from.size(); ++k) {
      const Vec<3> offset = p - from[k];
      const double distance = offset.norm();
      if (offset.z() >= of_scan[k].lowest * distance && offset.z() <= of_scan[k].highest * distance) return false;
    }
    return true;
  };
  const std::size_t nodes = parallel_reduce(
      grid.size(), std::size_t{1} << 14, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) count += view.state[i] == NodeState::unseen && missed(grid.position(i)) ? 1 : 0;
        return count;
      },
      [](std::size_t& sum, std::size_t part) { sum += part; });
  return static_cast<double>(nodes) * grid.spacing * grid.spacing * grid.spacing;
}

std::string ScanCoverage::note(double beyond) const {
  if (!(beyond > 0.0) || !limits()) return {};
  return fmt::format(
      "The scans say something of elevations from {:.0f} to {:.0f} degrees{}; nothing is expected beyond: {} m³ of the unseen are out of scope.",
      elevation_deg(all.lowest), elevation_deg(all.highest),
      all.each_way  ? ", in every direction up to the highest hit"
      : all.by_hits ? ", each up to its highest hit"
                    : "",
      amount_text(beyond));
}

Json ScanCoverage::json(double beyond) const {
  return {{"elevation_deg", {elevation_deg(all.lowest), elevation_deg(all.highest)}}, {"by_hits", all.by_hits}, {"out_of_scope_m3", beyond}};
}

}  // namespace vantage
