// SPDX-License-Identifier: Apache-2.0
#include "paper_views.h"

#include <algorithm>
#include <array>

#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"
#include "vantage/report/solids.h"
#include "vantage/report/unseen_faces.h"

using namespace vantage;

namespace {

constexpr double kLow = 0.2;  ///< Of the colours of heights.
constexpr Rgb kSky{219, 225, 233};

Rgb colour_of_kind(const std::string& kind) {
  constexpr std::array<std::pair<std::string_view, Rgb>, 10> kinds{{{"ground", {206, 203, 190}},
                                                                    {"tree", {104, 148, 84}},
                                                                    {"roof", {176, 104, 84}},
                                                                    {"furniture", {196, 150, 96}},
                                                                    {"column", {226, 218, 200}},
                                                                    {"house", {222, 208, 184}},
                                                                    {"church", {214, 206, 190}},
                                                                    {"vehicle", {92, 122, 168}},
                                                                    {"pipe", {128, 158, 190}},
                                                                    {"pole", {110, 104, 100}}}};
  for (const auto& [name, colour] : kinds)
    if (name == kind) return colour;
  return {196, 192, 184};
}

using Polygon = std::vector<Vec<3>>;

/// The part with `sign * (p[axis] - limit) >= 0` (Sutherland and Hodgman 1974).
Polygon cut(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec<3>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
    if (da >= 0.0) kept.push_back(a);
    if ((da >= 0.0) != (db >= 0.0)) kept.emplace_back(a + da / (da - db) * (b - a));
  }
  return kept;
}

/// The facets within the frame, as triangles.
struct Cut {
  Mesh<3> mesh;
  std::vector<Rgb> colours;
};

Cut cut_scene(const Scene<3>& scene, const Box<3>& frame) {
  Cut result;
  const auto add = [&](const Polygon& polygon, Rgb colour) {
    const auto first = static_cast<std::uint32_t>(result.mesh.vertices.size());
    result.mesh.vertices.insert(result.mesh.vertices.end(), polygon.begin(), polygon.end());
    for (std::uint32_t k = 2; k < polygon.size(); ++k) {
      result.mesh.facets.push_back({first, first + k - 1, first + k});
      result.colours.push_back(colour);
    }
  };
  for (const Scene<3>::Part& part : scene.parts) {
    for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
      Polygon polygon;
      for (const std::uint32_t corner : scene.mesh.facets[i]) polygon.push_back(scene.mesh.vertices[corner]);
      for (int axis = 0; axis < 3; ++axis) polygon = cut(cut(polygon, axis, 1.0, frame.low[axis]), axis, -1.0, frame.high[axis]);
      add(polygon, colour_of_kind(part.name));
    }
  }
  return result;
}

}  // namespace

Camera view_camera(const Scene<3>& scene, const Box<3>& frame, const PaperView& view) {
  const std::vector<Vec<3>> outline = cut_scene(scene, frame).mesh.vertices;
  return Camera::bird(frame, outline, radians(view.azimuth_deg), radians(view.elevation_deg), {view.width, view.height, 14.0});
}

Image scene_picture(const Scene<3>& scene, const Box<3>& frame, const Camera& camera) {
  const Cut cut = cut_scene(scene, frame);
  Raster raster(camera);
  draw_mesh(raster, cut.mesh, cut.colours);
  return resolved(raster, {0.9});
}

Image visibility_picture(const Field<3>& psi, const Field<3, NodeState>& state, const Camera& camera) {
  Raster raster(camera);
  draw_level(raster, level_surface(psi, state), kClay, kUnseenColour);
  return resolved(raster, {0.9});
}

Image points_picture(const std::vector<std::vector<Vec<3>>>& hits, const Box<3>& frame, const Camera& camera) {
  Raster raster(camera);
  const double low = frame.low.z(), height = frame.size().z();
  for (const std::vector<Vec<3>>& points : hits) {
    parallel_for(points.size(), 4096, [&](std::size_t i) {
      const Vec<3>& p = points[i];
      if (!frame.contains(p)) return;
      raster.point(p, 0.8, colour_of(ColourMap::viridis, kLow + (1.0 - kLow) * std::clamp((p.z() - low) / height, 0.0, 1.0)));
    });
  }
  return resolved(raster, {0.7});
}

Image patches_picture(std::span<const Patch<3>> patches, const Box<3>& frame, const Camera& camera) {
  Raster raster(camera);
  draw_patches(raster, patches, {frame, {frame.low.z(), frame.high.z()}, Colours::clay});
  return resolved(raster, {1.0});
}

Image on_plate(const Image& picture) {
  Canvas canvas(picture.width, picture.height, kSky);
  canvas.lay(picture, 0, 0);
  return canvas.image();
}

Image with_stations(const Image& picture, std::span<const Vec<3>> stations, const Camera& camera) {
  Canvas canvas(on_plate(picture));
  const std::vector<Vec<2>> places = on_canvas(stations, camera);
  for (std::size_t i = places.size(); i-- > 0;) draw_pin(canvas, places[i], static_cast<int>(i), 10.5);
  return canvas.image();
}

std::vector<Vec<3>> stations_of(const PaperRun<3>& run) {
  std::vector<Vec<3>> places;
  for (const auto& step : run.steps) places.push_back(step.vantage);
  return places;
}
