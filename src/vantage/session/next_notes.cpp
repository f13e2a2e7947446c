// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/session/scan_log.h"

namespace vantage {

std::string place_text(const Vec<3>& p) { return fmt::format("{:.2f}, {:.2f}, {:.2f}", p[0], p[1], p[2]); }

std::string amount_text(double amount) { return amount < 100.0 ? fmt::format("{:.3g}", amount) : fmt::format("{:.0f}", amount); }

std::string input_line(const MeasuredInput& input) {
  const BinReport& r = input.report;
  std::string out =
      fmt::format("{}: {} points ({}), taken at {} ({})", input.name, r.points, input.format, place_text(input.scan.origin), input.pose);
  if (r.near > 0) out += fmt::format("; {} nearer than {:g} m left out", r.near, input.scan.pattern.min_range);
  if (r.far > 0) out += fmt::format("; {} beyond {:g} m left out", r.far, input.scan.pattern.max_range);
  if (input.not_finite > 0) out += fmt::format("; {} not finite left out", input.not_finite);
  if (input.filtered.mixed > 0) out += fmt::format("; {} mixed pixels left out", input.filtered.mixed);
  if (input.filtered.isolated > 0) out += fmt::format("; {} isolated points left out", input.filtered.isolated);
  return out;
}

std::string no_return_note(std::span<const MeasuredInput> inputs, const MeasuredOptions& options) {
  std::int64_t all = 0, empty = 0, outside = 0, between = 0;
  double low = kPi, high = -kPi, step = 0.0, range = 0.0;
  for (const MeasuredInput& input : inputs) {
    all += static_cast<std::int64_t>(input.scan.ranges.size());
    empty += input.report.empty;
    outside += input.report.outside;
    between += input.report.between;
    low = std::min(low, input.report.lowest);
    high = std::max(high, input.report.highest);
    step = std::max(step, input.report.step);
    range = std::max(range, input.scan.pattern.max_range);
  }
  const auto share = [&](std::int64_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(all, 1)); };
  const bool free = options.no_return == MeasuredOptions::NoReturn::free;
  return fmt::format(
      "Directions were binned every {:.3g} degrees. Those between elevations of {:.0f} and {:.0f} degrees that hit nothing ({:.1f} %) {}; {:.1f} % "
      "lie "
      "between hits close by, on the surface between them; of the {:.1f} % outside nothing is known.",
      degrees(step), degrees(low), degrees(high), share(empty),
      free ? fmt::format("count as free up to {:g} m (--no-return unknown otherwise)", range) : "count as unknown", share(between), share(outside));
}

std::string filter_note(std::span<const MeasuredInput> inputs, const FilterOptions& options) {
  FilterReport sum;
  for (const MeasuredInput& input : inputs) {
    sum.points += input.filtered.points;
    sum.mixed += input.filtered.mixed;
    sum.isolated += input.filtered.isolated;
  }
  const auto share = [&](std::int64_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(sum.points, 1)); };
  using What = FilterOptions::What;
  std::string out = fmt::format("Of {} points the filter left out", sum.points);
  if (options.what != What::isolated)
    out += fmt::format(
        " {} mixed pixels ({:.2f} %: between a nearer and a farther neighbour, both at least {:g} m off and within {:g} degrees of the ray)",
        sum.mixed, share(sum.mixed), options.jump, degrees(options.angle));
  if (options.what != What::mixed)
    out += fmt::format("{} {} isolated points ({:.2f} %: fewer than {} others within {:g} distances between rays)",
                       options.what == What::both ? " and" : "", sum.isolated, share(sum.isolated), options.neighbours, options.radius);
  return out + ". Their rays end where they did: nothing behind them counts as seen.";
}

std::string moved_note(std::size_t moved, std::size_t points, double gap) {
  return fmt::format(
      "Of {} points {} ({:.2f} %) were left out as moved: rays of another scan go on at least {:g} m behind them, and no other scan met "
      "anything so near to them. Nothing is taken from their rays.",
      points, moved, 100.0 * static_cast<double>(moved) / static_cast<double>(std::max<std::size_t>(points, 1)), gap);
}

Json input_json(const MeasuredInput& input) {
  return {{"name", input.name},
          {"format", input.format},
          {"points", input.report.points},
          {"pose", input.pose},
          {"step_deg", degrees(input.report.step)},
          {"left_out",
           {{"near", input.report.near},
            {"far", input.report.far},
            {"not_finite", input.not_finite},
            {"mixed", input.filtered.mixed},
            {"isolated", input.filtered.isolated}}},
          {"crc32", fmt::format("{:08x}", scan_fingerprint<3>(input.scan))}};
}

}  // namespace vantage
