// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "vantage/report/maps.h"
#include "vantage/report/overlay.h"
#include "vantage/report/pictures.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr Rgb kSurface{29, 95, 214}, kLoose{234, 120, 40};

Box<3> flat(const Box<2>& box) { return {Vec<3>(box.low.x(), box.low.y(), 0.0), Vec<3>(box.high.x(), box.high.y(), 0.0)}; }
Vec<3> at(const Vec<2>& p, double z) { return {p.x(), p.y(), z}; }

void draw_patches(Raster& raster, const ReportInput<2>& input) {
  parallel_for(input.patches.size(), 256, [&](std::size_t i) {
    const Patch<2>& patch = input.patches[i];
    const auto corners = patch.corners();
    if (patch.rank() == 0) {
      raster.point(at(corners[0], 0.0), 2.0, kLoose);
    } else {
      raster.segment(at(corners[0], 0.0), at(corners[1], 0.0), 2.6, kSurface);
    }
  });
}

Image faint_states(const ReportInput<2>& input, const Camera& camera) {
  StateColours colours = kLightStates;
  colours.obstacle = mix(colours.obstacle, colours.seen, 0.55);
  return state_map(input.state, camera, colours);
}

std::string map_scale(const Camera& camera) { return scale_overlay(1.0 / camera.pixel_size(1.0), camera.width(), camera.height()); }

Figure map_figure(const ReportInput<2>& input, const Camera& camera) {
  Raster raster(camera);
  draw_patches(raster, input);
  Image image = faint_states(input, camera);
  lay_over(image, resolved(raster, {0.0}));
  Figure figure{"surface", "The map", {}, {}, {}};
  figure.caption = fmt::format(
      "What was seen, what stays unseen (numbers as in the table below), and the surface rebuilt from the points: {} segments and {} single points; no "
      "measured point is farther than {} from them.",
      number(input.surface.fits), number(input.surface.loose_points), quantity(input.surface.data_to_surface, "m"));
  figure.legend = legend_entry("line", css(kSurface), "surface") + legend_entry("dot", css(kLoose), "single point") +
                  legend_entry("area", css(kLightStates.seen), "seen") + legend_entry("hatch", css(kLightStates.unseen), "unseen") +
                  legend_entry("area", css(mix(kLightStates.obstacle, kLightStates.seen, 0.55)), "obstacle");
  figure.panels.push_back({std::move(image), unseen_overlay(input, camera) + map_scale(camera), "Map of seen and unseen space with the rebuilt surface.", {}});
  return figure;
}

Figure path_figure(const ReportInput<2>& input, const Camera& camera) {
  Raster raster(camera);
  const double scans = std::max<double>(1.0, static_cast<double>(input.scan_points.size()) - 1.0);
  for_drawn_points(input, [&](std::size_t scan, const Vec<2>& p) {
    raster.point(at(p, 0.0), 1.6, colour_of(ColourMap::viridis, 0.9 * static_cast<double>(scan) / scans));
  });
  Image image = faint_states(input, camera);
  lay_over(image, resolved(raster, {0.0}));
  double length = 0.0;
  for (const StepRecord<2>& step : input.steps) length += step.path_length;
  Figure figure{"path", "The scans and the path", {}, {}, {}};
  figure.caption = fmt::format("{} points of {}, coloured by the scan that measured them, and the vantage points in their order: {} of path in all.",
                               number(static_cast<std::int64_t>(point_count(input))), counted(static_cast<std::int64_t>(input.steps.size()), "scan", "scans"),
                               quantity(length, "m"));
  figure.legend = legend_bar(css_gradient(ColourMap::viridis, 0.0, 0.9), "first scan", "last scan") + journey_legend();
  figure.panels.push_back({std::move(image), journey_overlay(input, camera) + map_scale(camera),
                           "Map with the measured points, the numbered vantage points and the path through them.", {}});
  return figure;
}

/// What the scans up to the snapshot's tell of the obstacles.
Panel known_panel(const ReportInput<2>& input, const Snapshot<2>& snapshot) {
  const Camera camera = Camera::map(map_box(snapshot.state.window), panel_frame(input.picture_width));
  Raster raster(camera);
  for_drawn_points(input, [&](std::size_t scan, const Vec<2>& p) {
    if (scan < input.steps.size() && input.steps[scan].scan <= snapshot.step) raster.point(at(p, 0.0), 1.5, kSurface);
  });
  Panel panel{state_map(snapshot.state, camera, kLightStates), {}, {}, {}};
  lay_over(panel.image, resolved(raster, {0.0}));
  panel.overlay = diamond_overlay(on_picture<2>(snapshot.vantage, camera));
  if (snapshot.has_next) {
    const std::vector<Vec<2>> next{snapshot.next};
    for (const Vec<2>& pixel : on_picture<2>(next, camera)) panel.overlay += cross_overlay(pixel);
  }
  panel.caption = fmt::format("After scan {}", snapshot.step);
  panel.alt = panel.caption + ": what is known of the map";
  return panel;
}

Figure known_figure(const ReportInput<2>& input) {
  Figure figure{"known", "Step by step", {}, {}, {}};
  figure.caption = "What was known after some of the scans: the obstacles' outlines measured so far, and what was still unseen.";
  figure.legend = legend_entry("line", css(kSurface), "outline measured so far") + legend_entry("diamond", "", "vantage points so far") +
                  legend_entry("cross", "", "next") + legend_entry("hatch", css(kLightStates.unseen), "unseen");
  for (const Snapshot<2>* snapshot : chosen(input.snapshots)) {
    if (snapshot->state.window.size() > 0) figure.panels.push_back(known_panel(input, *snapshot));
  }
  return figure;
}

}  // namespace

template <>
std::vector<Figure> pictures(const ReportInput<2>& input) {
  std::vector<Figure> figures;
  if (input.domain.empty()) return figures;
  const Camera camera = Camera::map(flat(input.domain), map_frame(input.picture_width));
  if (!input.patches.empty() || input.state.window.size() > 0) figures.push_back(map_figure(input, camera));
  if (!input.steps.empty()) figures.push_back(path_figure(input, camera));
  for (Figure figure : {known_figure(input), metric_figure(input.snapshots, panel_frame(input.picture_width))}) {
    if (!figure.panels.empty()) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace vantage
