// SPDX-License-Identifier: Apache-2.0
#include "audit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "audit_measures.h"
#include "vantage/report/bars.h"
#include "vantage/report/curves.h"
#include "vantage/report/html.h"
#include "vantage/report/text.h"

using vantage::Bars;
using vantage::Chart;
using vantage::Curve;
using vantage::details;
using vantage::escaped;
using vantage::Json;
using vantage::table;

namespace {

constexpr const char* kColours[] = {"var(--c1)", "var(--c2)", "var(--c3)", "var(--c4)", "var(--c5)", "var(--c6)", "var(--c7)", "var(--c8)"};
constexpr const char* kOracleColours[] = {"var(--ink)", "var(--soft)", "var(--mark)"};
constexpr const char* kOracleNames[] = {"oracle", "oracle, seen", "oracle, walls"};

std::string fixed(const Json& value, int digits) { return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), digits) : "–"; }
std::string share(const Json& value) { return value.is_number() ? fmt::format("{:.1f} %", 100.0 * value.get<double>()) : "–"; }

std::string duration(const Json& seconds) {
  if (!seconds.is_number()) return "–";
  const auto minutes = static_cast<int>(std::lround(seconds.get<double>() / 60.0));
  if (minutes < 2) return fmt::format("{:.0f} s", seconds.get<double>());
  return minutes < 120 ? fmt::format("{} min", minutes) : fmt::format("{}:{:02} h", minutes / 60, minutes % 60);
}

Curve curve(const std::string& name, const char* colour, const Json& coverage, bool unseen) {
  Curve curve{.name = name, .colour = colour, .style = Curve::Style::line, .x = {}, .y = {}};
  for (std::size_t k = 0; k < coverage.size(); ++k) {
    curve.x.push_back(static_cast<double>(k + 1));
    const double seen = coverage[k].get<double>();
    curve.y.push_back(100.0 * (unseen ? 1.0 - seen : seen));
  }
  return curve;
}

std::vector<Curve> curves_of(const Json& scene, bool unseen) {
  std::vector<Curve> curves;
  for (std::size_t o = 0; o < std::size(kOracles); ++o) {
    curves.push_back(curve(kOracleNames[o], kOracleColours[o], scene.at("oracles").at(kOracles[o]), unseen));
    curves.back().style = Curve::Style::dashed;
  }
  std::size_t v = 0;
  for (const auto& [name, sums] : scene.at("variants").items())
    curves.push_back(curve(name, kColours[v++ % std::size(kColours)], sums.at("coverage"), unseen));
  return curves;
}

std::string charts(const Json& scene) {
  Chart seen;
  seen.title = "Seen";
  seen.caption = "Share of the reachable visible volume after so many scans, mean over the runs.";
  seen.x_label = "scans";
  seen.unit = "%";
  seen.curves = curves_of(scene, false);
  double low = 90.0;
  for (const Curve& c : seen.curves)
    for (const double y : c.y) low = std::min(low, y);
  seen.low = std::max(0.0, 10.0 * std::floor(0.1 * low));
  seen.high = 100.0;
  Chart left;
  left.title = "Still unseen";
  left.caption = "The same, from the other end: 1 % is where a run counts as done.";
  left.x_label = "scans";
  left.unit = "%";
  left.logarithmic = true;
  left.curves = curves_of(scene, true);
  for (Curve& c : left.curves)  // Below a tenth of a per cent nothing is compared.
    for (double& y : c.y) y = std::max(y, 0.1);
  return chart_html(seen) + chart_html(left);
}

std::string waste(const Json& variants) {
  Bars bars{.title = "Scans up to 99 %",
            .caption = "Mean over the runs. Idle: less than 0.1 % gained. Missed: runs that never get there, counted as their cap.",
            .mark = "oracle",
            .parts = {{"useful", "var(--c1)"}, {"idle", "var(--c2)"}, {"missed", "var(--mark)"}},
            .rows = {}};
  for (const auto& [name, sums] : variants.items()) {
    const Json& scans = sums.at("scans_a_run");
    bars.rows.push_back({name,
                         {scans.at("useful").get<double>(), scans.at("idle").get<double>(), scans.at("missed").get<double>()},
                         sums.at("oracles").at(kOracles[0]).at("n99").get<double>()});
  }
  return bars_html(bars);
}

std::string ratios(const Json& variants) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, sums] : variants.items())
    rows.push_back({escaped(name), fmt::format("{}", sums.at("runs").get<int>()), fmt::format("{}", sums.at("missed").get<int>()),
                    fixed(sums.at("n95"), 1), fixed(sums.at("n99"), 1), fixed(sums.at("ratio_n95"), 2),
                    "<b>" + fixed(sums.at("ratio_n99"), 2) + "</b>", fixed(sums.at("ratio_n99_best"), 2), fixed(sums.at("ratio_n99_bound"), 2),
                    fixed(sums.at("ratio_n99_seen"), 2), fixed(sums.at("ratio_n99_walls"), 2), fixed(sums.at("worst_n99"), 2),
                    share(sums.at("idle_share"))});
  return table({"variant", ">runs", ">missed", ">scans to 95 %", ">to 99 %", ">95 % / oracle", ">99 % / oracle", ">/ best", ">/ bound", ">/ seen",
                ">/ walls", ">worst", ">idle"},
               rows);
}

std::string costs(const Json& variants) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, sums] : variants.items()) {
    const Json& verdicts = sums.at("verdicts");
    rows.push_back({escaped(name), fixed(sums.at("path_m"), 0) + " m", duration(sums.at("time_s").at("walk")),
                    duration(sums.at("time_s").at("drone")), fixed(sums.at("most_false_free_m3"), 2), fixed(sums.at("false_hidden_m3"), 2),
                    share(sums.at("surface_share")), share(sums.at("thin_recall")),
                    verdicts.at("judged") == 0 ? "–" : fmt::format("{} of {}", verdicts.at("right").get<int>(), verdicts.at("judged").get<int>())});
  }
  return table(
      {"variant", ">way to 99 %", ">walking", ">flying", ">falsely free, most", ">falsely hidden", ">surface seen", ">thin parts", ">right verdicts"},
      rows);
}

/// How far the greedy oracle is from the best one; of the first variant, since all have the same starts.
std::string bounds(const Json& variants) {
  const Json& sums = variants.front();
  const Json& bound = sums.at("oracles").at(kBound);
  if (bound.is_null()) return {};
  return fmt::format("<p class=\"note\">Scans to 99 %, mean over the starts: oracle {}, best found {}, at least {} (proven best at {} of {}).</p>\n",
                     fixed(sums.at("oracles").at(kOracles[0]).at("n99"), 1), fixed(bound.at("best"), 1), fixed(bound.at("n99"), 1),
                     bound.at("proven").get<int>(), sums.at("runs").get<int>());
}

std::string tables(const Json& variants) { return bounds(variants) + ratios(variants) + "<div style=\"height:28px\"></div>\n" + costs(variants); }

std::string scene_html(const Json& scene) {
  const auto layouts = scene.at("layouts").get<std::vector<std::string>>();
  const std::string which = layouts.size() > 1 ? fmt::format("{} layouts, ", layouts.size()) : std::string();
  return fmt::format("<section><h2>{}</h2><p class=\"note\">{}{} runs</p>\n<div class=\"charts\">\n{}{}</div>\n{}</section>\n",
                     escaped(scene.at("scene").get<std::string>()), which, scene.at("runs").size(), charts(scene), waste(scene.at("variants")),
                     tables(scene.at("variants")));
}

std::string variants_html(const Json& plan) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, variant] : plan.at("variants").items()) {
    std::string settings;
    for (const auto& [option, value] : variant.at("settings").items())
      settings += fmt::format("{}{} = {}", settings.empty() ? "" : ", ", option, value.template get<std::string>());
    rows.push_back({escaped(name), escaped(variant.at("what").get<std::string>()), escaped(settings)});
  }
  return details("The variants", table({"variant", "what", "options"}, rows));
}

std::string method_html(const Json& plan) {
  return details(
      "How it is measured",
      "<p class=\"note\">The reference is all free space that a reachable place can see. Every run begins where its oracles begin. "
      "oracle: greedy cover with the map in hand, from anywhere; seen: only from places that earlier scans have seen; walls: 99 % of the walls "
      "must be seen too, at a cosine of at least 0.1 (trees, vehicles, furniture, poles, wires, fences and railings are no walls). "
      "best: the fewest scans to 99 % that were found with the map in hand; bound: a proof that fewer than so many scans cannot do. "
      "Ratios are sums over sums. Walking: 1 m/s and 120 s a scan; flying: 2 m/s and 2 s. Falsely free: called seen, but no reachable place "
      "sees it. Falsely hidden: in true sight of a scan, but not called seen. Volumes are areas in 2D. A run may take " +
          vantage::rounded(plan.at("cap").get<double>()) + " times the scans of its oracle.</p>\n");
}

}  // namespace

std::string audit_report(const Json& audit) {
  const Json& plan = audit.at("plan");
  std::string body = fmt::format(
      "<header><p class=\"eyebrow\">vantage audit</p><h1>How few scans?</h1>\n<p class=\"note\">{}{} in each layout.</p></header>\n<main>\n",
      audit.at("complete") == Json(true) ? "" : "Not complete: the same command goes on. ",
      vantage::counted(plan.at("starts").get<std::int64_t>(), "start", "starts"));
  if (audit.at("scenes").size() > 1)
    body += "<section><h2>All scenes</h2>\n<div style=\"max-width:560px\">" + waste(audit.at("all")) + "</div>\n" + tables(audit.at("all")) +
            "</section>\n";
  for (const Json& scene : audit.at("scenes")) body += scene_html(scene);
  body += "<section>" + method_html(plan) + variants_html(plan) + "</section>\n</main>\n<footer></footer>\n";
  return vantage::page("vantage audit", body);
}
