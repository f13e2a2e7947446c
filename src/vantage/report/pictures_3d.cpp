// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "vantage/geometry/angle.h"
#include "vantage/report/maps.h"
#include "vantage/report/overlay.h"
#include "vantage/report/pictures_3d.h"
#include "vantage/report/solids.h"
#include "vantage/report/text.h"
#include "vantage/report/unseen_faces.h"

namespace vantage {

namespace {

constexpr double kLowColour = 0.2, kHighColour = 1.0;  ///< Part of viridis that reads on light and dark grounds.

/// Calls `body(box)` for all that was met and visited inside the domain.
template <class Body>
void for_contents(const ReportInput<3>& input, const Body& body) {
  const auto place = [&](const Vec<3>& p) {
    if (input.domain.contains(p)) body(Box<3>{p, p});
  };
  for (const Patch<3>& patch : input.patches) {
    const Box<3> part = patch.bounds().intersection(input.domain);
    if (!part.empty()) body(part);
  }
  for (const auto& points : input.scan_points) {
    for (const Vec<3>& p : points) place(p);
  }
  for (const StepRecord<3>& step : input.steps) place(step.vantage);
}

/// What the pictures frame.
Box<3> contents(const ReportInput<3>& input) {
  Box<3> box;
  for_contents(input, [&box](const Box<3>& part) { box.extend(part); });
  return box.empty() ? input.domain : box;
}

/// Corners of the contents, column by column: closer to them than the corners of the whole box.
std::vector<Vec<3>> outline(const ReportInput<3>& input, const Box<3>& box) {
  constexpr int kColumns = 12;
  std::vector<Box<3>> columns(kColumns * kColumns);
  const Vec<3> size = box.size().cwiseMax(1e-9);
  for_contents(input, [&](const Box<3>& part) {
    const Vec<3> place = (part.center() - box.low).cwiseQuotient(size) * kColumns;
    const int x = std::clamp(static_cast<int>(place.x()), 0, kColumns - 1), y = std::clamp(static_cast<int>(place.y()), 0, kColumns - 1);
    columns[static_cast<std::size_t>(y * kColumns + x)].extend(part);
  });
  std::vector<Vec<3>> places;
  for (const Box<3>& column : columns) {
    if (column.empty()) continue;
    for (const Vec<3>& p : corners(column)) places.push_back(p);
  }
  if (places.empty()) places.assign(1, box.center());
  return places;
}

/// Looks along the longer side, from the south-west, at the contents and `parts` beside them.
Camera bird(const ReportInput<3>& input, const Box<3>& contents, std::span<const Box<3>> parts) {
  const int width = input.picture_width;
  Box<3> box = contents;
  std::vector<Vec<3>> places = outline(input, contents);
  for (const Box<3>& part : parts) {
    box.extend(part);
    for (const Vec<3>& p : corners(part)) places.push_back(p);
  }
  const double azimuth = box.size().x() >= box.size().y() ? 66.0 : 24.0;
  return Camera::bird(box, places, radians(azimuth), radians(38.0), {width, width * 7 / 10, 28.0});
}

double point_radius(const ReportInput<3>& input, const Camera& camera) {
  const double drawn = static_cast<double>(point_count(input) / point_stride(input)) + 1.0;
  return std::clamp(0.6 * std::sqrt(camera.width() * static_cast<double>(camera.height()) / drawn), 0.85, 3.0);
}

Figure points_figure(const ReportInput<3>& input, const Camera& camera) {
  const auto [low, high] = height_range(input);
  Raster raster(camera);
  const double radius = point_radius(input, camera);
  for_drawn_points(input, [&, low = low, high = high](std::size_t, const Vec<3>& p) {
    const double t = std::clamp((p.z() - low) / (high - low), 0.0, 1.0);
    raster.point(p, radius, colour_of(ColourMap::viridis, kLowColour + (kHighColour - kLowColour) * t));
  });
  Figure figure{"points", "Everything the scanner measured", {}, {}, {}};
  std::size_t measured = 0;
  for (const auto& step : input.steps) measured += static_cast<std::size_t>(step.points);
  measured = std::max(measured, point_count(input));  // Of which the input may hold a share.
  const std::size_t stride = measured / std::max<std::size_t>(1, point_count(input) / point_stride(input));
  const std::string share = stride > 1 ? fmt::format(" About one in {} is drawn.", stride) : std::string();
  figure.caption =
      fmt::format("{} points of {}, coloured by height, with the vantage points and the path through them.{}",
                  number(static_cast<std::int64_t>(measured)), counted(static_cast<std::int64_t>(input.steps.size()), "scan", "scans"), share);
  figure.legend = legend_bar(css_gradient(ColourMap::viridis, kLowColour, kHighColour), height_text(low), height_text(high)) + journey_legend();
  figure.panels.push_back({resolved(raster, {0.8}),
                           journey_overlay(input, camera),
                           fmt::format("Bird's view of the measured points, height {} to {}.", height_text(low), height_text(high)),
                           {}});
  return figure;
}

Figure surface_figure(const ReportInput<3>& input, const Camera& camera) {
  Raster raster(camera);
  draw_patches(raster, input.patches, {input.domain, height_range(input), Colours::by_kind});
  Figure figure{"surface", "The surface rebuilt from the points", {}, {}, {}};
  figure.caption =
      fmt::format("{} flat pieces, {} thin ones and {} single points; no measured point is farther than {} from them.", number(input.surface.fits),
                  number(input.surface.segments), number(input.surface.loose_points), quantity(input.surface.data_to_surface, "m"));
  figure.legend = legend_entry("area", css(kClay), "flat piece") + legend_entry("line", css(kWire), "thin piece (wire, pole, edge)") +
                  legend_entry("dot", css(kLoose), "single point");
  figure.panels.push_back({resolved(raster, {1.0}), {}, "Bird's view of the reconstructed surface, shaded.", {}});
  return figure;
}

Figure unseen_figure(const ReportInput<3>& input, const Camera& camera) {
  Raster surfaces(camera), unseen(camera);
  draw_patches(surfaces, input.patches, {input.domain, height_range(input), Colours::clay});
  draw_unseen(unseen, input.state);
  Figure figure{"unseen", "What stays unseen", {}, {}, {}};
  figure.caption =
      "The border between the space that was seen and the space that was not; it shows through the surfaces. Numbers are those of the table below.";
  figure.legend = legend_entry("area", css(kUnseenColour), "unseen space") + legend_entry("area", css(kClay), "surface");
  figure.panels.push_back({unseen_image(surfaces, unseen),
                           unseen_overlay(input, camera),
                           fmt::format("Bird's view of the unseen space, {} listed.",
                                       counted(static_cast<std::int64_t>(input.verdict.unseen.size()), "region", "regions")),
                           {}});
  return figure;
}

Figure path_figure(const ReportInput<3>& input, const Box<3>& box) {
  const Camera camera = Camera::map(box, map_frame(input.picture_width));
  const double cut = plan_height(input);
  Raster raster(camera);
  // Even at the floor, single points are as light as the flat pieces around them.
  const double floor = height_range(input).first;
  draw_plan(raster, input.patches, {input.domain, {floor - 1.0, floor}, Colours::clay}, {cut, 0.5 * input.state.window.spacing});
  double length = 0.0;
  for (const StepRecord<3>& step : input.steps) length += step.path_length;
  Figure figure{"path", "The path", {}, {}, {}};
  figure.caption = fmt::format("Plan, cut at a height of {1}, with the vantage points in their order: {0} of path in all.", quantity(length, "m"),
                               height_text(cut));
  figure.legend = journey_legend() + legend_entry("line", css(kSection), "wall at the cut");
  figure.panels.push_back({resolved(raster, {0.0}),
                           journey_overlay(input, camera) + scale_overlay(1.0 / camera.pixel_size(1.0), camera.width(), camera.height()),
                           "Plan of the place with the numbered vantage points and the path through them.",
                           {}});
  return figure;
}

}  // namespace

std::pair<double, double> height_range(const ReportInput<3>& input) {
  std::vector<double> heights;
  const std::size_t stride = 8 * point_stride(input);
  std::size_t index = 0;
  for (const auto& points : input.scan_points) {
    for (const Vec<3>& p : points) {
      if (index++ % stride == 0 && input.domain.contains(p)) heights.push_back(p.z());
    }
  }
  if (heights.empty()) return {input.domain.low.z(), input.domain.high.z()};
  std::ranges::sort(heights);
  const double low = heights[heights.size() / 100], high = heights[heights.size() - 1 - heights.size() / 100];
  return {low, std::max(high, low + 1e-3)};
}

std::string height_text(double z) { return fmt::format("{:.1f}\u00a0m", std::abs(z) < 0.05 ? 0.0 : z); }

Image unseen_image(const Raster& surfaces, const Raster& unseen) {
  Image image = resolved(surfaces, {0.8}), veil = resolved(unseen, {0.8});
  for (int y = 0; y < veil.height; ++y) {
    for (int x = 0; x < veil.width; ++x) {
      const int sx = x * Raster::kSamples, sy = y * Raster::kSamples;
      const bool hidden = !unseen.empty(sx, sy) && !surfaces.empty(sx, sy) && surfaces.distance(sx, sy) < unseen.distance(sx, sy);
      std::uint8_t& alpha = veil.pixel(x, y)[3];
      alpha = static_cast<std::uint8_t>(alpha * (hidden ? 0.5 : 0.82));
    }
  }
  lay_over(image, veil);
  return image;
}

double plan_height(const ReportInput<3>& input) {
  double lowest = kInfinity;
  for (const StepRecord<3>& step : input.steps) lowest = std::min(lowest, step.vantage.z());
  return lowest;
}

template <>
std::vector<Figure> pictures(const ReportInput<3>& input) {
  std::vector<Figure> figures;
  if (input.domain.empty()) return figures;
  const Box<3> box = contents(input);
  const Camera camera = bird(input, box, {});
  const std::vector<Box<3>> parts = next_parts(input, box);
  Box<3> all = box;
  for (const Box<3>& part : parts) all.extend(part);
  for (Figure& figure : next_figures(input, all, bird(input, box, parts))) figures.push_back(std::move(figure));
  if (point_count(input) > 0) figures.push_back(points_figure(input, camera));
  if (!input.patches.empty()) figures.push_back(surface_figure(input, camera));
  if (input.state.window.size() > 0) figures.push_back(unseen_figure(input, camera));
  if (!input.steps.empty()) figures.push_back(path_figure(input, box));
  Figure metric = metric_figure(input.snapshots, panel_frame(input.picture_width));
  if (!metric.panels.empty()) figures.push_back(std::move(metric));
  return figures;
}

}  // namespace vantage
