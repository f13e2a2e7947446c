// SPDX-License-Identifier: Apache-2.0
#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numbers.h"

using vantage::Json;
using vantage::RunEnd;

namespace {

std::string line(std::string_view key, const std::string& value) { return fmt::format("  {:<9} {}\n", key, value); }

double number(const Json& json) { return json.is_number() ? json.get<double>() : 0.0; }

std::string seen_sentence(const Json& verdict) {
  return fmt::format("{:.2f} % of what can be seen (between {:.2f} and {:.2f} %)", 100.0 * number(verdict["seen_fraction"]),
                     100.0 * number(verdict["seen_fraction_bounds"][0]), 100.0 * number(verdict["seen_fraction_bounds"][1]));
}

std::string unseen_sentence(const Json& unseen, const char* unit) {
  if (unseen.empty()) return "nothing of note";
  const double largest = number(unseen[0]["volume_m3"]);
  const std::string size = largest < 1000.0 ? fmt::format("{:.1f}", largest) : grouped(static_cast<std::int64_t>(largest));
  return fmt::format("{} {}, the largest {} {} ({})", unseen.size(), unseen.size() == 1 ? "place" : "places", size, unit,
                     unseen[0]["reason"].get<std::string>());
}

std::string headline(const vantage::RunOutcome& outcome) {
  const Json& verdict = outcome.result["verdict"];
  const std::string state = outcome.end == RunEnd::interrupted  ? "stopped"
                            : verdict["complete"].get<bool>()   ? "complete"
                            : outcome.end == RunEnd::scan_limit ? "limit reached"
                                                                : "not complete";
  return fmt::format("{}: {}. {}\n", outcome.result["scene"].get<std::string>(), state, verdict["reason"].get<std::string>());
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return grouped(value.get<std::int64_t>());
  if (value.is_number_float()) {
    int digits = 6;  // More of large coordinates, for their millimetres.
    for (double size = std::abs(value.get<double>()); size >= 1e3 && digits < 15; size /= 10.0) ++digits;
    return fmt::format("{:.{}g}", value.get<double>(), digits);
  }
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_array()) return "-";
  std::string out;
  for (const Json& item : value) {
    if (!out.empty()) out += item.is_array() ? "  to  " : ", ";
    out += value_text(item);
  }
  return out;
}

std::string lines_of(const Json& json, std::size_t indent) {
  std::size_t width = 0;
  for (const auto& [key, value] : json.items()) width = value.is_object() ? width : std::max(width, key.size());
  std::string out;
  for (const auto& [key, value] : json.items()) {
    std::string name = key;
    std::replace(name.begin(), name.end(), '_', ' ');
    if (value.is_object())
      out += fmt::format("{:{}}{}\n{}", "", indent, name, lines_of(value, indent + 2));
    else
      out += fmt::format("{:{}}{:<{}}  {}\n", "", indent, name, width, value_text(value));
  }
  return out;
}

}  // namespace

std::string surface_sentence(const Json& s, int dim) {
  const auto count = [&](const char* key) { return s[key].get<std::int64_t>(); };
  std::string out = fmt::format("{} {}", grouped(count("fits")), dim == 2 ? "segments" : "polygons");
  if (count("segments") > 0) out += fmt::format(", {} segments", grouped(count("segments")));
  if (count("loose_points") > 0) out += fmt::format(", {} single points", grouped(count("loose_points")));
  out += fmt::format(" from {} points, error at most {:.3g} m", grouped(count("points")), number(s["hausdorff"]["certified_m"]));
  return out + fmt::format(" (eta {:.3g} m)", number(s["eta_m"]));
}

std::string map_sentence(const Json& m) {
  const auto count = [&](const char* key) { return m.contains(key) ? m[key].get<std::int64_t>() : 0; };
  const std::int64_t deltas = count("deltas");
  std::string out = fmt::format("{} {} of {} {}, {} bytes: ", grouped(deltas), deltas == 1 ? "delta" : "deltas", m["sources"].size(),
                                m["sources"].size() == 1 ? "source" : "sources", grouped(count("bytes")));
  if (count("dim") != 2) out += fmt::format("{} polygons, ", grouped(count("polygons")));
  if (count("dim") == 2) out += fmt::format("{} segments, ", grouped(count("segments")));
  out += fmt::format("{} points, error at most {:.3g} m", grouped(count("points")),
                     std::max(number(m["data_to_surface_m"]), number(m["surface_to_data_m"])));
  if (count("missing_deltas") > 0)
    out += fmt::format(", {} earlier {} missing", grouped(count("missing_deltas")), count("missing_deltas") == 1 ? "delta" : "deltas");
  return out + fmt::format("; sha256 {:.16}", m["sha256"].get<std::string>());
}

std::string summary(const vantage::RunOutcome& outcome) {
  const Json& result = outcome.result;
  const int dim = result["dim"].get<int>();
  std::string out = headline(outcome);
  out += line("scans", fmt::format("{} in {}", result["scans"].get<int>(), duration(outcome.seconds)));
  out += line("seen", seen_sentence(result["verdict"]));
  out += line("unseen", unseen_sentence(result["verdict"]["unseen"], dim == 2 ? "m²" : "m³"));
  out += line("surface", surface_sentence(result["surface"], dim));
  out += line("path", fmt::format("{:.1f} m", number(result["path_m"])));
  if (outcome.end == RunEnd::interrupted || outcome.end == RunEnd::scan_limit) out += line("go on", resume_hint(outcome));
  return out + fmt::format("report: {}\n", (outcome.folder / vantage::run_file::kReport).string());
}

std::string resume_hint(const vantage::RunOutcome& outcome) { return fmt::format("vantage explore --resume -o {}", outcome.folder.string()); }

std::string as_lines(const Json& json) { return lines_of(json, 0); }
