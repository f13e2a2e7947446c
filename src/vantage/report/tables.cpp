// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "vantage/geometry/angle.h"
#include "vantage/report/curves.h"
#include "vantage/report/html.h"
#include "vantage/report/maps.h"
#include "vantage/report/sections.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr std::size_t kListed = 12;  ///< Unseen regions in the open table; the rest is folded.

/// What the verdict's words mean for someone on the ground.
std::string explained(const std::string& reason) {
  if (reason == "enclosed") return "enclosed: surfaces on all sides, no opening leads in";
  if (reason == "no reachable view") return "no reachable view: no place the scanner can stand looks into it";
  if (reason == "beyond range") return "beyond range: farther from every reachable place than the scanner reaches";
  if (reason == "below the threshold") return "below the threshold: a further scan was expected to show less than the stated minimum";
  if (reason == "too fine for the lattice") return "too fine for the lattice: openings narrower than two lattice steps";
  return reason;
}

std::string capital(std::string_view word) {
  std::string text(word);
  text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

template <int Dim>
std::string size_text(const Box<Dim>& box) {
  if (box.empty()) return "–";
  std::string text;
  for (int a = 0; a < Dim; ++a) text += fmt::format("{}{:.1f}", a > 0 ? " × " : "", box.size()[a]);
  return text + "\u00a0m";
}

template <int Dim>
std::string unseen_html(const Verdict<Dim>& verdict) {
  std::string html = "<section id=\"left\"><h2>What stays unseen, and why</h2>\n";
  if (verdict.unseen.empty()) return html + "<p class=\"note\">No region above the reporting threshold stays unseen.</p></section>\n";
  const std::vector<std::string> columns{">No.",
                                         ">" + capital(volume_word<Dim>()) + " [" + std::string(volume_unit<Dim>()) + "]",
                                         ">May open [" + std::string(volume_unit<Dim>()) + "]",
                                         "Size",
                                         "Around",
                                         "Why",
                                         "May open from [m]"};
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < verdict.unseen.size(); ++i) {
    const UnseenRegion<Dim>& region = verdict.unseen[i];
    rows.push_back({number(static_cast<std::int64_t>(i + 1)), number(region.volume), number(region.may_open), size_text<Dim>(region.box),
                    region.box.empty() ? "–" : place_text<Dim>(region.box.center()), escaped(explained(region.reason)),
                    region.open_from ? place_text<Dim>(*region.open_from) : "–"});
  }
  const auto split = rows.begin() + static_cast<std::ptrdiff_t>(std::min(kListed, rows.size()));
  html += table(columns, {rows.begin(), split});
  if (split != rows.end()) html += details(fmt::format("{} more, smaller ones", rows.end() - split), table(columns, {split, rows.end()}));
  return html + "</section>\n";
}

template <int Dim>
std::string flat_html(const NextPlan<Dim>& plan, const char* unit) {
  std::vector<std::vector<std::string>> rows;
  for (const FlatRegion<Dim>& region : plan.flat)
    rows.push_back({number(region.area), number(degrees(region.incidence)), size_text<Dim>(region.box), place_text<Dim>(region.box.center())});
  const std::vector<std::string> columns{fmt::format(">Surface [{}]", unit), ">Mean angle [°]", "Size", "Around"};
  const auto split = rows.begin() + static_cast<std::ptrdiff_t>(std::min(kListed, rows.size()));
  std::string html = fmt::format(
      "<section id=\"flat\"><h2>What was only seen too flat</h2>\n<p class=\"note\">{} of known surface in all; the angle is "
      "that between the best ray and the surface's normal.</p>\n",
      quantity(plan.flat_area, unit));
  html += table(columns, {rows.begin(), split});
  if (split != rows.end()) html += details(fmt::format("{} more, smaller ones", rows.end() - split), table(columns, {split, rows.end()}));
  return html + "</section>\n";
}

template <int Dim>
std::string steps_table(const std::vector<StepRecord<Dim>>& steps) {
  std::vector<std::vector<std::string>> rows;
  for (const StepRecord<Dim>& step : steps) {
    rows.push_back({number(static_cast<std::int64_t>(step.scan)), place_text<Dim>(step.vantage), number(step.points), number(step.new_volume),
                    percent(step.seen_fraction), number(step.path_length), number(step.next_score), number(step.expected_volume),
                    number(step.candidates)});
  }
  const std::string unit(volume_unit<Dim>());
  return table({">Scan", "Vantage point [m]", ">Points", ">New [" + unit + "]", ">Seen share", ">Path [m]", ">Next max E",
                ">Expected next [" + unit + "]", ">Candidates"},
               rows);
}

/// Where the axis of the seen share starts [%].
template <int Dim>
double lowest_share(const std::vector<StepRecord<Dim>>& steps) {
  double lowest = 1.0;
  for (const StepRecord<Dim>& step : steps) lowest = std::min(lowest, step.seen_fraction);
  return std::clamp(10.0 * std::floor(10.0 * lowest), 0.0, 90.0);
}

/// One value a step.
template <int Dim, class Value>
Curve over_scans(const std::vector<StepRecord<Dim>>& steps, const Value& value) {
  Curve curve;
  for (const StepRecord<Dim>& step : steps) {
    curve.x.push_back(step.scan);
    curve.y.push_back(value(step));
  }
  return curve;
}

Curve named(Curve curve, std::string name, std::string colour, Curve::Style style = Curve::Style::line) {
  curve.name = std::move(name);
  curve.colour = std::move(colour);
  curve.style = style;
  return curve;
}

}  // namespace

template <int Dim>
std::string curves_html(const ReportInput<Dim>& input) {
  const auto& steps = input.steps;
  if (steps.empty()) return {};
  using Step = StepRecord<Dim>;
  const std::string word(volume_word<Dim>()), unit(volume_unit<Dim>());

  Chart share{"Seen share",
              "Of what can be seen; the band shows the bounds of the final share.",
              "scan",
              "%",
              false,
              lowest_share(steps),
              100.0,
              100.0 * input.verdict.seen_low,
              100.0 * input.verdict.seen_high,
              {}};
  share.curves.push_back(
      named(over_scans(steps, [](const Step& s) { return 100.0 * s.seen_fraction; }), percent(steps.back().seen_fraction), "var(--c1)"));

  Chart gain{"New " + word + " of each scan",
             "What each scan was the first to see, beside what the planner expected of it; scans that showed nothing new are left out.",
             "scan",
             unit,
             true,
             0,
             0,
             0,
             0,
             {}};
  Curve expected = over_scans(steps, [](const Step& s) { return s.expected_volume; });
  for (double& x : expected.x) x += 1.0;  // It speaks of the scan that follows.
  expected.x.pop_back();
  expected.y.pop_back();
  gain.curves.push_back(named(over_scans(steps, [](const Step& s) { return s.new_volume; }), "seen", "var(--c1)"));
  gain.curves.push_back(named(std::move(expected), "expected", "var(--c2)", Curve::Style::dots));

  Chart metric{"Largest metric E after each scan", "Over all candidates for the next vantage point.", "scan", "", false, 0, 0, 0, 0, {}};
  metric.curves.push_back(named(over_scans(steps, [](const Step& s) { return s.next_score; }), "max E", "var(--c3)"));

  Chart way{"Path so far", "Length of the path through the vantage points.", "scan", "m", false, 0, 0, 0, 0, {}};
  double length = 0.0;
  Curve sum = over_scans(steps, [&length](const Step& s) { return length += s.path_length; });
  way.curves.push_back(named(std::move(sum), quantity(length, "m"), "var(--c2)", Curve::Style::area));

  std::string html = "<section id=\"curves\"><h2>How it went</h2>\n<div class=\"charts\">\n";
  for (const Chart* chart : {&share, &gain, &metric, &way}) html += chart_html(*chart);
  return html + "</div></section>\n";
}

template <int Dim>
std::string tables_html(const ReportInput<Dim>& input) {
  std::string html = unseen_html(input.verdict);
  html += "<section id=\"run\"><h2>The run</h2>\n";
  if (!input.command.empty()) html += "<p class=\"note\">To repeat it:</p>\n<pre><code>" + escaped(input.command) + "</code></pre>\n<p></p>\n";
  if (!input.steps.empty()) html += details("All steps", steps_table<Dim>(input.steps));
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, value] : input.settings) rows.push_back({"<code>" + escaped(name) + "</code>", escaped(value)});
  if (!rows.empty()) html += details("All settings", table({"Setting", "Value"}, rows));
  return html + "</section>\n";
}

template <int Dim>
std::string next_html(const ReportInput<Dim>& input) {
  std::string html;
  const bool mends = input.plan.flat_area > 0.0;
  const char* surface_unit = std::array{"m", "m²"}[Dim - 2];
  if (!input.next.empty()) {
    html += "<section id=\"next-places\"><h2>Where to scan next</h2>\n";
    std::vector<std::vector<std::string>> rows;
    for (std::size_t k = 0; k < input.next.size(); ++k) {
      const RankedPlace<Dim>& place = input.next[k];
      double way = 0.0;
      for (std::size_t i = 1; i < place.path.size(); ++i) way += (place.path[i] - place.path[i - 1]).norm();
      rows.push_back({number(static_cast<std::int64_t>(k + 1)), escaped(place_text<Dim>(place.position)),
                      quantity(place.new_volume, volume_unit<Dim>()), quantity(place.added_volume, volume_unit<Dim>()), percent(place.overlap),
                      quantity(way, "m")});
      if (mends) rows.back().push_back(quantity(place.mended, surface_unit));
    }
    const std::string word(volume_word<Dim>());
    std::vector<std::string> columns{">Rank", "Place", ">New " + word, ">Beyond the better ones", ">Known in view", ">Way"};
    if (mends) columns.push_back(">Seen better");
    html += table(columns, rows);
    html += "<p class=\"note\">Best first. New " + word +
            " is what the place is expected to show; the next column leaves out what the places above it will have shown. Known in view: the share "
            "of known "
            "surface in what is seen from there, to register the scan by." +
            (mends ? " Seen better: surface that was only seen too flat and would be faced." : "") + "</p>\n</section>\n";
  }
  if (!input.plan.flat.empty()) html += flat_html<Dim>(input.plan, surface_unit);
  if (input.notes.empty()) return html;
  html += "<section id=\"notes\"><h2>What was assumed</h2>\n<ul>\n";
  for (const std::string& note : input.notes) html += "<li>" + escaped(note) + "</li>\n";
  return html + "</ul></section>\n";
}

template std::string next_html(const ReportInput<2>&);
template std::string next_html(const ReportInput<3>&);
template std::string curves_html(const ReportInput<2>&);
template std::string curves_html(const ReportInput<3>&);
template std::string tables_html(const ReportInput<2>&);
template std::string tables_html(const ReportInput<3>&);

}  // namespace vantage
