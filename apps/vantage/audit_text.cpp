// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "audit_measures.h"
#include "audit_report.h"

using vantage::Json;

namespace {

std::string fixed(const Json& value, int digits) { return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), digits) : "-"; }

std::string line(const std::string& name, const Json& sums, const Json& seconds) {
  const Json& oracles = sums.at("oracles");
  const auto bound = [&](const char* what) { return fixed(oracles.at(kBound).is_null() ? Json(nullptr) : oracles.at(kBound).at(what), 1); };
  return fmt::format(
      "  {:<12} {:>4} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>7} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>5}/{:<5} {:>8} {:>9} {:>8} {:>8} "
      "{:>6}\n",
      name, sums.at("runs").get<int>(), sums.at("missed").get<int>(), fixed(sums.at("n90"), 1), fixed(sums.at("n95"), 1), fixed(sums.at("n99"), 1),
      fixed(oracles.at(kOracles[0]).at("n99"), 1), bound("best"), bound("n99"), fixed(oracles.at(kOracles[1]).at("n99"), 1),
      fixed(oracles.at(kOracles[2]).at("n99"), 1), fixed(sums.at("ratio_n95"), 2), fixed(sums.at("ratio_n99"), 2),
      fixed(sums.at("ratio_n99_bound"), 2), fixed(sums.at("ratio_n99_walls"), 2), fixed(sums.at("worst_n99"), 2), sums.at("idle").get<int>(),
      sums.at("picks").get<int>(), fixed(sums.at("path_m"), 0), fixed(sums.at("most_false_free_m3"), 2),
      fmt::format("{}/{}", sums.at("verdicts").at("right").get<int>(), sums.at("verdicts").at("judged").get<int>()),
      fixed(seconds.is_object() ? seconds.at("seconds_a_scan") : Json(nullptr), 3),
      fixed(seconds.is_object() ? seconds.at("peak_memory_mib") : Json(nullptr), 0));
}

std::string head(const std::string& scene) {
  return fmt::format(
      "{:<14} {:>4} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>7} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>11} {:>8} {:>9} {:>8} {:>8} {:>6}\n",
      scene, "runs", "missed", "n90", "n95", "n99", "oracle", "best", "bound", "(seen)", "(wall)", "r95", "r99", "r99b", "r99w", "worst",
      "idle/picks", "path m", "max free", "verdicts", "s/scan", "MiB");
}

/// Place and share, scan by scan.
std::string curve(const std::string& name, const Json& places, const Json& coverage) {
  std::string out = name + "\n";
  for (std::size_t k = 0; k < coverage.size(); ++k)
    out += fmt::format("{:>4}  {:.4f}  at {:.2f}\n", k + 1, coverage[k].get<double>(), fmt::join(places[k].get<std::vector<double>>(), ", "));
  return out;
}

std::string scans(const Json& n) { return n.is_null() ? "never" : fmt::format("{}", n.get<int>()); }

std::string score_line(const std::string& name, const Json& n) {
  return fmt::format("  {:<18} {:>6} {:>6} {:>6}\n", name, scans(n.at("n90")), scans(n.at("n95")), scans(n.at("n99")));
}

}  // namespace

std::string audit_text(const Json& audit, const Json& timing, bool with_curves) {
  std::string out;
  for (std::size_t s = 0; s < audit.at("scenes").size(); ++s) {
    const Json& scene = audit.at("scenes")[s];
    out += head(scene.at("scene"));
    for (const auto& [name, sums] : scene.at("variants").items())
      out += line(name, sums, timing.at("scenes")[s].at("variants").value(name, Json(nullptr)));
    if (!with_curves) continue;
    for (const Json& start : scene.at("starts")) {
      const std::string where = fmt::format("{} start {}", start.at("scene").get<std::string>(), start.at("start").get<int>());
      const Json& oracle = start.at("oracles").at(kOracles[0]);
      out += curve(where + " oracle", oracle.at("places"), oracle.at("coverage"));
      for (const Json& run : scene.at("runs"))
        if (run.at("scene") == start.at("scene") && run.at("start") == start.at("start"))
          out += curve(where + " " + run.at("variant").get<std::string>(), run.at("places"), run.at("coverage"));
    }
  }
  if (audit.at("scenes").size() > 1) {
    out += head("all");
    for (const auto& [name, sums] : audit.at("all").items()) out += line(name, sums, nullptr);
  }
  return out;
}

std::string score_text(const Json& score, bool with_curves) {
  const Json& verdict = score.at("verdict");
  std::string out =
      fmt::format("{}: {} scans, {:.2f} % seen, {:.1f} m\n", score.at("scene").get<std::string>(), score.at("scans").get<int>(),
                  100.0 * verdict.at("true_fraction").get<double>(), score.at("way_m").empty() ? 0.0 : score.at("way_m").back().get<double>());
  out += fmt::format("scans to           {:>8} {:>6} {:>6}\n", "90 %", "95 %", "99 %") + score_line("this run", score);
  for (const char* oracle : kOracles) out += score_line(fmt::format("oracle, {}", oracle), score.at("oracles").at(oracle));
  if (const Json& bound = score.at("oracles").at(kBound); !bound.is_null()) {
    out += fmt::format("  {:<18} {:>20}\n", "best found", bound.at("best").get<int>());
    out += fmt::format("  {:<18} {:>20}\n", "bound", bound.at("n99").get<int>());
  }
  for (const auto& [name, run] : score.at("baselines").items()) out += score_line(name, run);
  out += fmt::format("idle picks up to 99 %: {} of {}; falsely free {} m³, falsely hidden {} m³; surface seen {}\n", score.at("idle").get<int>(),
                     score.at("picks").get<int>(), fixed(score.at("false_free_m3"), 2), fixed(score.at("false_hidden_m3"), 2),
                     fixed(score.at("surface_share"), 4));
  const std::string right = verdict.at("right").is_null() ? "" : verdict.at("right") == Json(true) ? ", right" : ", wrong";
  out += fmt::format("verdict: {}{}: {}\n", verdict.at("complete").get<bool>() ? "complete" : "not complete", right,
                     verdict.at("reason").get<std::string>());
  if (!with_curves) return out;
  const Json& oracle = score.at("oracles").at(kOracles[0]);
  out += curve("this run", score.at("places"), score.at("coverage")) + curve("oracle", oracle.at("places"), oracle.at("coverage"));
  return out;
}
