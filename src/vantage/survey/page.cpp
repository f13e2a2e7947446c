// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/parallel.h"
#include "vantage/base/version.h"
#include "vantage/report/curves.h"
#include "vantage/report/html.h"
#include "vantage/report/maps.h"
#include "vantage/report/overlay.h"
#include "vantage/report/raster.h"
#include "vantage/report/text.h"
#include "vantage/survey/survey.h"

namespace vantage {
namespace {

constexpr int kWidth = 1400;  // Of the map [pixels].
constexpr Rgb kMissed{214, 60, 44};

/// Seen from above.
template <int Dim>
Vec<2> flat(const Vec<Dim>& p) {
  return p.template head<2>();
}

/// Where one can be at some height: `seen` on the map, the rest `obstacle`.
template <int Dim>
Field<2, NodeState> plan(const Field<Dim, std::uint8_t>& reachable) {
  const Grid<Dim>& grid = reachable.window;
  Field<2, NodeState> map(Grid<2>{grid.spacing, grid.first.template head<2>(), grid.extent.template head<2>()}, NodeState::obstacle);
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (reachable[i] != 0) map[i % map.values.size()] = NodeState::seen;
  return map;
}

std::vector<Vec<2>> pixels(std::span<const Vec<2>> places, const Camera& camera) {
  std::vector<Vec<2>> out;
  for (const Vec<2>& p : places) {
    const Projected at = camera.project({p[0], p[1], 0.0});
    out.emplace_back(at.x, at.y);
  }
  return out;
}

template <int Dim>
std::string tour_overlay(const Survey<Dim>& survey, const Camera& camera) {
  std::vector<Vec<2>> path, places;
  std::vector<int> numbers;
  for (const auto& leg : survey.legs)
    for (const Vec<Dim>& p : leg) path.push_back(flat<Dim>(p));
  for (const auto& station : survey.stations) {
    numbers.push_back(static_cast<int>(places.size()));
    places.push_back(flat<Dim>(station.place));
  }
  return path_overlay(pixels(path, camera)) + station_overlay(pixels(places, camera), numbers) +
         scale_overlay(1.0 / camera.pixel_size(1.0), camera.width(), camera.height());
}

double colour_at(std::uint8_t times) { return std::min(1.0, 0.25 + 0.25 * times); }

template <int Dim>
Figure map_figure(const Survey<Dim>& survey) {
  const Field<2, NodeState> map = plan(survey.reachable);
  const Camera camera = Camera::map(map_box(map.window), map_frame(kWidth));
  StateColours colours = kLightStates;
  colours.obstacle = mix(colours.obstacle, colours.seen, 0.7);
  Raster raster(camera);
  parallel_for(survey.seen.size(), 1024, [&](std::size_t i) {
    const Vec<2> p = flat<Dim>(survey.seen[i].place);
    const std::uint8_t times = survey.times[i];
    raster.point({p[0], p[1], times == 0 ? 1.0 : 0.0}, times == 0 ? 2.5 : 1.7, times == 0 ? kMissed : colour_of(ColourMap::viridis, colour_at(times)));
  });
  Image image = state_map(map, camera, colours);
  lay_over(image, resolved(raster, {0.0}));
  Figure figure{"map", "The stations and the tour", {}, {}, {}};
  figure.caption = "From above: where the scanner can be, the samples of the walls by how many stations measure them, the stations and the way through them.";
  figure.legend = legend_bar(css_gradient(ColourMap::viridis, colour_at(1), 1.0), "1 station", "3 or more") +
                  legend_entry("dot", css(kMissed), "not measured") + legend_entry("area", css(colours.seen), "reachable") +
                  legend_entry("area", css(colours.obstacle), "not reachable");
  figure.panels.push_back({std::move(image), tour_overlay(survey, camera), "Map of the stations and the tour.", {}});
  return figure;
}

template <int Dim>
std::string header(const Survey<Dim>& survey, const std::string& scene) {
  const auto count = static_cast<std::int64_t>(survey.stations.size());
  const auto entry = [](const std::string& name, const std::string& value, const std::string& note) {
    return fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>\n", escaped(name), escaped(value), escaped(note));
  };
  std::string html = fmt::format("<header class=\"{}\">\n<p class=\"eyebrow\">Survey of a known place</p>\n<h1>{}</h1>\n", survey.linked ? "done" : "not-done",
                                 escaped(scene));
  html += fmt::format("<div class=\"verdict\"><p>{} {} what is asked for{}; no choice among the places looked at needs fewer than {}.</p></div>\n<dl>\n",
                      counted(count, "station", "stations"), count == 1 ? "measures" : "measure",
                      survey.linked ? "" : ", but some cannot be joined by the overlap asked for", survey.at_least);
  html += entry("Stations", number(count), fmt::format("at least {}", survey.at_least));
  html += entry("Way", quantity(survey.length(), "m"), survey.options.come_back ? "and back to the start" : "from the start to the last");
  html += entry("Wall", quantity(survey.wall, std::array<std::string_view, 2>{"m", "m²"}[Dim - 2]), "some reachable place measures within the limits");
  html += entry("Measured", percent(survey.share), fmt::format("of {} samples", number(survey.demands)));
  return html + "</dl>\n</header>\n";
}

template <int Dim>
std::string curve(const Survey<Dim>& survey) {
  Curve greedy{"greedy", "var(--c1)", Curve::Style::line, {}, {}};
  for (std::size_t k = 0; k < survey.greedy.size(); ++k) {
    greedy.x.push_back(static_cast<double>(k + 1));
    greedy.y.push_back(100.0 * survey.greedy[k]);
  }
  return "<section><div class=\"charts\">\n" + chart_html({"Stations and what they see", "Share of the samples measured once, by the number of stations, the best first.", "stations", "%", false,
                     0.0, 100.0, 0.0, 0.0, {greedy}}) + "</div></section>\n";
}

template <int Dim>
std::string station_table(const Survey<Dim>& survey) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < survey.stations.size(); ++k) {
    const Station<Dim>& s = survey.stations[k];
    rows.push_back({number(static_cast<std::int64_t>(k)), place_text<Dim>(s.place), number(s.sees), number(s.adds), percent(s.overlap),
                    s.partner < 0 ? "–" : number(static_cast<std::int64_t>(s.partner))});
  }
  return "<section><h2>Stations</h2>\n" + table({">Station", "Place [m]", ">Sees", ">New", ">Overlap", ">With"}, rows) + "</section>\n";
}

}  // namespace

template <int Dim>
std::string survey_page(const Survey<Dim>& survey, const std::string& scene) {
  const std::string body = header(survey, scene) + "<main>\n" + figures_html({map_figure(survey)}) + curve(survey) + station_table(survey) +
                           "</main>\n<footer>Made by vantage " + escaped(kVersion) + ". Lengths in metres.</footer>\n";
  return page(scene + " – survey", body);
}

template std::string survey_page<2>(const Survey<2>&, const std::string&);
template std::string survey_page<3>(const Survey<3>&, const std::string&);

}  // namespace vantage
