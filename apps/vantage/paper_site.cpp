// SPDX-License-Identifier: Apache-2.0
#include "paper_site.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/audit/coverage.h"

using namespace vantage;

namespace {

constexpr double kEnough = 0.99;

std::vector<Setting> site_settings(const char* eta, bool quick) { return {{"explore.grid", quick ? "30" : "60", ""}, {"surface.eta", eta, ""}}; }

SiteMap map_of(const Explorer<3>& explorer) {
  return {explorer.psi(), explorer.states(), explorer.surface().patches(), explorer.surface().statistics(), {}, {}};
}

SiteRun explored(const PaperSite& site, const PaperPlace<3>& place, const Variant& variant, const std::string& label, Observer& observer) {
  SiteRun result{variant.name, label, {}, 0.0, {}};
  const PaperLimits limits{2 * site.scans, 2.0, site.figure + ": " + variant.name};
  std::int64_t scans = 0;
  result.run = explore_place<3>(place, variant, limits, observer, [&](const Explorer<3>& explorer) {
    if (++scans > site.scans) return;
    result.map = map_of(explorer);
    result.falsely_free = coverage(place.trial().reference(), result.map.state).falsely_free;
  });
  const auto kept = static_cast<std::ptrdiff_t>(std::min(site.scans, scans));
  result.map.hits.assign(result.run.hits.begin(), result.run.hits.begin() + kept);
  for (std::ptrdiff_t k = 0; k < kept; ++k) result.map.stations.push_back(result.run.steps[static_cast<std::size_t>(k)].vantage);
  return result;
}

/// Lines of sight against the fits alone, as in Sec. IV-B.
Variant with_cones(const Variant& variant) {
  Variant cones = variant;
  cones.name += "+cones";
  cones.settings.push_back({"visibility.range_image", "false", ""});
  cones.settings.push_back({"visibility.cone_deg", "1", ""});
  return cones;
}

/// Where points count.
Box<3> counted_box(const PaperSite& site, const PaperPlace<3>& place) { return site.everything ? place.scene().mesh.bounds() : place.scene().domain; }

std::string share_text(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

}  // namespace

PaperSite patio_site(const std::string& figure, bool quick) { return {figure, "patio", site_settings("0.4", quick), quick ? 4 : 16, 1769061, false}; }

PaperSite church_site(const std::string& figure, bool quick) {
  return {figure, "church", site_settings("0.2", quick), quick ? 4 : 11, 1896786, true};
}

double SiteRun::seen_after(std::int64_t scans) const {
  return run.coverage[static_cast<std::size_t>(std::min<std::int64_t>(scans, std::ssize(run.coverage)) - 1)];
}

std::int64_t SiteRun::points(std::int64_t scans, const Box<3>& box) const {
  std::int64_t count = 0;
  for (std::int64_t k = 0; k < std::min<std::int64_t>(scans, std::ssize(run.hits)); ++k)
    for (const Vec<3>& p : run.hits[static_cast<std::size_t>(k)]) count += box.contains(p) ? 1 : 0;
  return count;
}

SiteRun explore_site(const PaperSite& site, const PaperPlace<3>& place, Observer& observer) {
  const PaperFormula& ours = paper_formulas().back();
  return explored(site, place, ours.variant, ours.label, observer);
}

std::vector<SiteRun> explore_site_by_all(const PaperSite& site, const PaperPlace<3>& place, Observer& observer) {
  std::vector<SiteRun> runs;
  for (const PaperFormula& formula : paper_formulas()) runs.push_back(explored(site, place, formula.variant, formula.label, observer));
  const PaperFormula& ours = paper_formulas().back();
  runs.push_back(explored(site, place, with_cones(ours.variant), "default, but seen by 1° cones", observer));
  return runs;
}

std::string site_table(const PaperSite& site, const PaperPlace<3>& place, const std::vector<SiteRun>& runs) {
  std::vector<std::vector<std::string>> rows{{"the paper", std::to_string(site.scans), grouped(site.points / site.scans), "", "", "", "", ""}};
  for (const SiteRun& run : runs) {
    const std::int64_t scans = std::min<std::int64_t>(site.scans, std::ssize(run.run.steps));
    rows.push_back({run.label, run.run.finished ? std::to_string(run.run.steps.size()) : fmt::format("> {}", run.run.steps.size()),
                    grouped(run.points(scans, counted_box(site, place)) / scans), share_text(run.seen_after(site.scans)),
                    count_text(run.run.scans_to(0.90)), count_text(run.run.scans_to(0.95)), count_text(run.run.scans_to(kEnough)),
                    fmt::format("{:.1f} m³", run.falsely_free)});
  }
  return markdown({"E", "scans in all", "points a scan", fmt::format("seen after {}", site.scans), "scans to 90 %", "95 %", "99 %", "falsely seen"},
                  rows);
}

Json site_json(const PaperSite& site, const PaperPlace<3>& place, const std::vector<SiteRun>& runs) {
  const Grid<3>& grid = runs.front().map.state.window;
  Json json{{"figure", site.figure},
            {"scene", site.scene},
            {"paper", {{"scans", site.scans}, {"points", site.points}, {"grid", {60, 60, 60}}}},
            {"grid", {grid.extent.x(), grid.extent.y(), grid.extent.z()}},
            {"voxel_m", grid.spacing},
            {"rows", Json::array()}};
  for (const SiteRun& run : runs)
    json["rows"].push_back({{"formula", run.name},
                            {"label", run.label},
                            {"scans", run.run.steps.size()},
                            {"finished", run.run.finished},
                            {"points", run.points(site.scans, counted_box(site, place))},
                            {"n90", count_json(run.run.scans_to(0.90))},
                            {"n95", count_json(run.run.scans_to(0.95))},
                            {"n99", count_json(run.run.scans_to(kEnough))},
                            {"coverage", run.run.coverage},
                            {"falsely_free_m3", run.falsely_free}});
  return json;
}
