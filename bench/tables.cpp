// SPDX-License-Identifier: Apache-2.0
#include "tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace vantage::bench {
namespace {

constexpr double kMega = 1e-6;

/// Letters as a reader sees them: UTF-8 without its continuation bytes.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t to, bool left) {
  const std::string gap(to - std::min(to, width(text)), ' ');
  return left ? text + gap : gap + text;
}

/// Three digits that count, but no exponent.
std::string number(double x) {
  if (!(x < kInfinity)) return "-";
  return x >= 100.0  ? fmt::format("{:.0f}", x)
         : x >= 10.0 ? fmt::format("{:.1f}", x)
         : x >= 1.0  ? fmt::format("{:.2f}", x)
                     : fmt::format("{:.3f}", x);
}

std::string side(const Side& s) { return fmt::format("{} / {} / {}", number(s.maximum), number(s.p99), number(s.mean)); }

std::string bound(const Output& o) {
  if (!o.data_to_surface) return "";
  return fmt::format("{} / {}", number(*o.data_to_surface), number(o.surface_to_data.value_or(kInfinity)));
}

nlohmann::json as_json(const Side& s) { return {{"max", s.maximum}, {"p99", s.p99}, {"mean", s.mean}}; }

}  // namespace

std::string Table::markdown() const {
  std::vector<std::size_t> widths(rows_.front().size(), 3);
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text = "|";
    for (std::size_t c = 0; c < row.size(); ++c) text += " " + padded(row[c], widths[c], c == 0) + " |";
    return text + "\n";
  };
  std::string text = line(rows_.front()) + "|";
  for (std::size_t c = 0; c < widths.size(); ++c) text += " " + std::string(widths[c] - 1, '-') + (c == 0 ? "-" : ":") + " |";
  text += "\n";
  for (std::size_t r = 1; r < rows_.size(); ++r) text += line(rows_[r]);
  return text;
}

std::string quality_table(const std::vector<Row>& rows) {
  Table table({"", "CPU s", "output s", "MB", "primitives", "file MB", "B/point", "data to surface [m]", "surface to data [m]", "certified", "poles",
               "wires", "add a scan, CPU ms"});
  for (const Row& row : rows) {
    const Figures& f = row.measured.figures;
    const Output& o = row.measured.output;
    if (!f.error.empty()) {
      table.add({row.title, f.error, "", "", "", "", "", "", "", "", "", "", ""});
      continue;
    }
    table.add({row.title, number(f.cpu), number(f.output_cpu), number(f.peak), fmt::format("{}", o.primitives), number(o.bytes * kMega),
               number(o.bytes / static_cast<double>(f.points)), side(row.score.data_to_surface), side(row.score.surface_to_data), bound(o),
               fmt::format("{:.4f}", row.score.poles), fmt::format("{:.4f}", row.score.wires), f.add_cpu ? number(*f.add_cpu * 1e3) : ""});
  }
  std::string text = table.markdown() + "\nPrimitives:\n\n";
  for (const Row& row : rows) text += fmt::format("* {}: {} {}\n", row.title, row.measured.output.primitives, row.measured.output.kind);
  return text;
}

std::string growth_table(const std::vector<Row>& rows) {
  Table table(
      {"", "scans", "points", "threads", "CPU s", "µs/point", "wall s", "MB", "primitives", "certified", "add a scan, CPU ms", "µs/point of it"});
  for (const Row& row : rows) {
    const Figures& f = row.measured.figures;
    const auto points = static_cast<double>(f.points);
    table.add({row.title, fmt::format("{}", row.job.scans), fmt::format("{}", f.points), fmt::format("{}", row.job.threads),
               f.error.empty() ? number(f.cpu) : f.error, number(f.cpu / points * 1e6), number(f.wall), number(f.peak),
               fmt::format("{}", row.measured.output.primitives), bound(row.measured.output), f.add_cpu ? number(*f.add_cpu * 1e3) : "",
               f.add_cpu ? number(*f.add_cpu / static_cast<double>(f.added_points) * 1e6) : ""});
  }
  return table.markdown();
}

nlohmann::json as_json(const Row& row) {
  const Figures& f = row.measured.figures;
  const Output& o = row.measured.output;
  nlohmann::json j{{"contender", row.job.contender},
                   {"title", row.title},
                   {"set", row.job.sets},
                   {"scans", row.job.scans},
                   {"threads", row.job.threads},
                   {"points", f.points},
                   {"cpu_s", f.cpu},
                   {"wall_s", f.wall},
                   {"output_cpu_s", f.output_cpu},
                   {"peak_mb", f.peak},
                   {"primitives", o.primitives},
                   {"kind", o.kind},
                   {"bytes", o.bytes},
                   {"error", f.error},
                   {"added_points", f.added_points}};
  if (f.add_cpu) j["add_cpu_s"] = *f.add_cpu;
  if (o.data_to_surface) j["certified"] = {{"data_to_surface", *o.data_to_surface}, {"surface_to_data", o.surface_to_data.value_or(kInfinity)}};
  if (row.judged)
    j["measured"] = {{"data_to_surface", as_json(row.score.data_to_surface)},
                     {"surface_to_data", as_json(row.score.surface_to_data)},
                     {"recall_poles", row.score.poles},
                     {"recall_wires", row.score.wires}};
  return j;
}

}  // namespace vantage::bench
