// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "vantage/report/sections.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

struct KeyFigure {
  std::string name, value, note;
};

template <int Dim>
double way(const ReportInput<Dim>& input) {
  double length = 0.0;
  for (const StepRecord<Dim>& step : input.steps) length += step.path_length;
  return length;
}

template <int Dim>
std::string scans(const ReportInput<Dim>& input) {
  return counted(static_cast<std::int64_t>(input.steps.size()), "scan", "scans");
}

template <int Dim>
std::string bounds(const ReportInput<Dim>& input) {
  const std::string low = percent(input.verdict.seen_low), high = percent(input.verdict.seen_high, true);
  return low == high ? "for certain" : low + " to " + high;
}

template <int Dim>
KeyFigure surface_figure(const SurfaceStatistics& surface) {
  const std::array<std::string, 2> names{"Segments", "Flat pieces"};
  const std::array<std::string, 2> thin{"", counted(surface.segments, "thin piece", "thin pieces") + ", "};
  return {names[Dim - 2], number(surface.fits), "and " + thin[Dim - 2] + counted(surface.loose_points, "single point", "single points")};
}

KeyFigure error_figure(const SurfaceStatistics& surface) {
  const bool kept = surface.certified() <= surface.eta;
  return {
      "Certified error", quantity(surface.certified(), "m"),
      fmt::format("{} the tolerance of {}, points to surface and surface to points", kept ? "within" : "above", rounded(surface.eta, 3) + "\u00a0m")};
}

template <int Dim>
std::vector<KeyFigure> key_figures(const ReportInput<Dim>& input) {
  std::int64_t points = 0;
  for (const auto& step : input.steps) points += step.points;  // The points of the pictures may be a share of them.
  const double seen = input.steps.empty() ? 0.0 : input.steps.back().seen_volume;
  return {{"Scans", number(static_cast<std::int64_t>(input.steps.size())), fmt::format("{} of path through them", quantity(way(input), "m"))},
          {"Points", number(points), input.steps.empty() ? "" : number(points / static_cast<std::int64_t>(input.steps.size())) + " a scan"},
          surface_figure<Dim>(input.surface),
          error_figure(input.surface),
          {fmt::format("Seen {}", volume_word<Dim>()), quantity(seen, volume_unit<Dim>()),
           fmt::format("on a lattice of {} nodes, {} apart", number(static_cast<std::int64_t>(input.state.window.size())),
                       rounded(input.state.window.spacing, 3) + "\u00a0m")}};
}

template <int Dim>
std::string gauge(const Verdict<Dim>& verdict) {
  const auto share = [](double value) { return 100.0 * std::clamp(value, 0.0, 1.0); };
  return fmt::format(
      "<div class=\"gauge\" role=\"img\" aria-label=\"Seen share {}\"><i class=\"bounds\" style=\"width:{:.2f}%\"></i><i "
      "style=\"width:{:.2f}%\"></i></div>\n",
      percent(verdict.seen_fraction), share(verdict.seen_high), share(verdict.seen_low));
}

/// The one number, and what it is: the share seen, or what the best next place would show.
template <int Dim>
std::pair<std::string, std::string> headline(const ReportInput<Dim>& input) {
  if (input.next.empty()) return {percent(input.verdict.seen_fraction), fmt::format("seen ({})", bounds(input))};
  return {fmt::format("+\u00a0{}", quantity(input.next.front().new_volume, volume_unit<Dim>())), "expected of the best place"};
}

/// What is left, by reasons.
template <int Dim>
std::string left_over(const Verdict<Dim>& verdict) {
  if (verdict.unseen.empty()) return {};
  std::map<std::string, std::int64_t> reasons;
  double volume = 0.0;
  for (const UnseenRegion<Dim>& region : verdict.unseen) {
    ++reasons[region.reason];
    volume += region.volume;
  }
  std::string list;
  for (const auto& [reason, count] : reasons) {
    const std::string share = reasons.size() > 1 ? number(count) + " " : count > 1 ? "all " : "";
    list += fmt::format("{}{}{}{}", list.empty() ? "" : ", ", share, reason == "no reachable view" ? "with " : "", reason);
  }
  const double rest = verdict.unseen_volume - volume;
  const std::string smaller =
      rest > 0.01 * volume ? fmt::format(" Smaller ones, not listed, add {}.", quantity(rest, volume_unit<Dim>())) : std::string();
  return fmt::format(" {} unseen, {} in all: {}.{}", counted(static_cast<std::int64_t>(verdict.unseen.size()), "region stays", "regions stay"),
                     quantity(volume, volume_unit<Dim>()), list, smaller);
}

std::string sentence(std::string text) {
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  if (text.empty()) return text;
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + ".";
}

}  // namespace

template <int Dim>
std::string verdict_text(const ReportInput<Dim>& input) {
  if (input.steps.empty()) return "No scan was taken, so nothing can be said of the place. " + sentence(input.verdict.reason);
  const std::string low = percent(input.verdict.seen_low), high = percent(input.verdict.seen_high, true);
  const std::string between = low == high ? std::string() : fmt::format(" (between {} and {})", low, high);
  std::string share = fmt::format("{} saw {} of what can be seen here{}. ", scans(input), percent(input.verdict.seen_fraction), between);
  // Of a person's scans nobody knows how much there is to see.
  if (!input.next.empty()) share = fmt::format("{} saw {}. ", scans(input), quantity(input.steps.back().seen_volume, volume_unit<Dim>()));
  return share + sentence(input.verdict.reason) + left_over(input.verdict);
}

template <int Dim>
std::string header_html(const ReportInput<Dim>& input) {
  const Verdict<Dim>& verdict = input.verdict;
  constexpr std::array<const char*, 2> words{"Exploration in the plane", "Exploration in space"};
  std::string html = fmt::format("<header class=\"{}\">\n<p class=\"eyebrow\">{}</p>\n<h1>{}</h1>\n", verdict.complete ? "done" : "not-done",
                                 input.next.empty() ? words[Dim - 2] : "Where to scan next", escaped(input.scene));
  const auto [figure_of, what] = headline(input);
  html += fmt::format("<div class=\"verdict\"><p><b>{}</b> {}</p>\n<div class=\"share\"><strong>{}</strong><span>{}</span></div></div>\n",
                      verdict.complete ? "Complete." : "Not complete.", escaped(verdict_text(input)), figure_of, what);
  html += (input.next.empty() ? gauge(verdict) : std::string()) + "<dl>\n";
  for (const KeyFigure& figure : key_figures(input)) {
    html += fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>\n", escaped(figure.name), escaped(figure.value), escaped(figure.note));
  }
  return html + "</dl>\n</header>\n";
}

template std::string verdict_text(const ReportInput<2>&);
template std::string verdict_text(const ReportInput<3>&);
template std::string header_html(const ReportInput<2>&);
template std::string header_html(const ReportInput<3>&);

}  // namespace vantage
