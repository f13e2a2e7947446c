// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/maps.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/report/overlay.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

constexpr std::size_t kPanels = 9;
constexpr double kDarkest = 0.16;  ///< Of the colour map, so that small E is told from none.
constexpr int kSingleReach = 3;    ///< Half a lone node's square [pixels].

float value_at(const Field<2, float>& field, int i, int j) {
  const Index<2> local(i, j);
  return field.window.inside(local) ? field.at(local) : std::nanf("");
}

/// Bilinear over the finite ones of the four nodes around; NaN with less than a quarter of the weight.
double interpolated(const Field<2, float>& field, const Vec<2>& p) {
  const Vec<2> place = p / field.window.spacing - field.window.first.cast<double>();
  const Vec<2> base(std::floor(place.x()), std::floor(place.y()));
  double sum = 0.0, weight = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const float value = value_at(field, static_cast<int>(base.x()) + dx, static_cast<int>(base.y()) + dy);
    if (!std::isfinite(value)) continue;
    const double w = (1.0 - std::abs(place.x() - base.x() - dx)) * (1.0 - std::abs(place.y() - base.y() - dy));
    sum += w * value;
    weight += w;
  }
  return weight >= 0.25 ? sum / weight : std::nan("");
}

/// E at every pixel, first between the nodes, then a square around each node that stands alone.
std::vector<float> metric_pixels(const Field<2, float>& metric, const Camera& camera) {
  const auto width = static_cast<std::size_t>(camera.width());
  std::vector<float> pixels(width * static_cast<std::size_t>(camera.height()));
  parallel_for(static_cast<std::size_t>(camera.height()), 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      pixels[y * width + x] = static_cast<float>(interpolated(metric, camera.ground(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5)));
    }
  });
  for (std::size_t i = 0; i < metric.values.size(); ++i) {
    if (!std::isfinite(metric[i])) continue;
    const Vec<2> p = metric.window.position(i);
    const Projected q = camera.project(Vec<3>(p.x(), p.y(), 0.0));
    for (int y = static_cast<int>(q.y) - kSingleReach; y <= static_cast<int>(q.y) + kSingleReach; ++y) {
      for (int x = static_cast<int>(q.x) - kSingleReach; x <= static_cast<int>(q.x) + kSingleReach; ++x) {
        if (x < 0 || y < 0 || x >= camera.width() || y >= camera.height()) continue;
        float& pixel = pixels[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
        if (!std::isfinite(pixel)) pixel = metric[i];
      }
    }
  }
  return pixels;
}

float largest(const Field<2, float>& metric) {
  float most = 0.0F;
  for (const float value : metric.values) {
    if (std::isfinite(value)) most = std::max(most, value);
  }
  return most;
}

const NodeState* state_under(const Field<2, NodeState>& state, const Camera& camera, int x, int y) {
  const Index<2> node = state.window.nearest(camera.ground(x + 0.5, y + 0.5));
  return state.window.inside(node) ? &state.at(node) : nullptr;
}

template <int Dim>
std::vector<Vec<2>> on_map(const std::vector<Vec<Dim>>& places, const Camera& camera) {
  std::vector<Vec<2>> pixels;
  for (const Vec<Dim>& p : places) {
    const Projected q = camera.project(Vec<3>(p[0], p[1], 0.0));
    pixels.emplace_back(q.x, q.y);
  }
  return pixels;
}

template <int Dim>
std::string height_text(const Snapshot<Dim>& snapshot) {
  const std::array<std::string, 2> texts{"", fmt::format(", cut at {:.1f}\u00a0m", snapshot.height)};
  return texts[Dim - 2];
}

template <int Dim>
Panel metric_panel(const Snapshot<Dim>& snapshot, const PictureFrame& frame) {
  const Camera camera = Camera::map(map_box(snapshot.state.window), frame);
  Panel panel{state_map(snapshot.state, camera, kDarkStates), {}, {}, {}};
  lay_over(panel.image, metric_map(snapshot.metric, snapshot.state, camera));
  panel.overlay = diamond_overlay(on_map<Dim>(snapshot.vantage, camera));
  const std::string after = fmt::format("After scan {}{}", snapshot.step, height_text(snapshot));
  if (snapshot.has_next) {
    panel.overlay += cross_overlay(on_map<Dim>({snapshot.next}, camera)[0]);
    panel.caption = fmt::format("{}: best place {}", after, place_text(snapshot.next));
  } else {
    panel.caption = after + ": nothing left to visit";
  }
  panel.alt = panel.caption;
  return panel;
}

}  // namespace

Box<3> map_box(const Grid<2>& window) {
  const Box<2> box = window.bounds().grown(0.5 * window.spacing);
  return {Vec<3>(box.low.x(), box.low.y(), 0.0), Vec<3>(box.high.x(), box.high.y(), 0.0)};
}

Image state_map(const Field<2, NodeState>& state, const Camera& camera, const StateColours& colours) {
  Image image(camera.width(), camera.height());
  parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width; ++x) {
      const NodeState* under = state_under(state, camera, x, y);
      if (under == nullptr) continue;
      const Rgb unseen = (x + y) % 10 < 3 ? colours.hatch : colours.unseen;
      image.set(x, y, *under == NodeState::seen ? colours.seen : *under == NodeState::obstacle ? colours.obstacle : unseen);
    }
  });
  return image;
}

Image metric_map(const Field<2, float>& metric, const Field<2, NodeState>& state, const Camera& camera) {
  Image image(camera.width(), camera.height());
  const float most = largest(metric);
  if (metric.values.empty()) return image;
  const std::vector<float> pixels = metric_pixels(metric, camera);
  parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width; ++x) {
      const float value = pixels[row * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)];
      const NodeState* under = state_under(state, camera, x, y);
      if (!std::isfinite(value) || under == nullptr || *under != NodeState::seen) continue;
      const double t = most > 0.0F ? std::max(value, 0.0F) / most : 0.0;
      // Steps of 1/64 keep the palette of the picture small.
      image.set(x, y, colour_of(ColourMap::inferno, kDarkest + (1.0 - kDarkest) * std::round(t * 64.0) / 64.0));
    }
  });
  return image;
}

template <int Dim>
std::vector<const Snapshot<Dim>*> chosen(const std::vector<Snapshot<Dim>>& snapshots) {
  std::vector<const Snapshot<Dim>*> picked;
  const std::size_t count = std::min(kPanels, snapshots.size());
  picked.reserve(count);
  for (std::size_t k = 0; k < count; ++k) picked.push_back(&snapshots[count == 1 ? 0 : k * (snapshots.size() - 1) / (count - 1)]);
  return picked;
}

template <int Dim>
Figure metric_figure(const std::vector<Snapshot<Dim>>& snapshots, const PictureFrame& frame) {
  Figure figure;
  figure.id = "metric";
  figure.title = "Where it pays to look next";
  figure.caption =
      "The visibility metric E on cuts through the place, each scaled to its own maximum: the brighter, the more a scan from there would reveal. "
      "The cross is where the scanner went next.";
  figure.legend = legend_bar(css_gradient(ColourMap::inferno, kDarkest, 1.0), "E small", "large") +
                  legend_entry("diamond", "", "vantage points so far") + legend_entry("cross", "", "next") +
                  legend_entry("area", css(kDarkStates.obstacle), "obstacle") + legend_entry("hatch", css(kDarkStates.unseen), "unseen") +
                  legend_entry("area", css(kDarkStates.seen), "seen, E not asked");
  for (const Snapshot<Dim>* snapshot : chosen(snapshots)) {
    if (snapshot->state.window.size() > 0) figure.panels.push_back(metric_panel(*snapshot, frame));
  }
  return figure;
}

template <int Dim>
std::string place_text(const Vec<Dim>& p) {
  std::string text;
  for (int a = 0; a < Dim; ++a) text += fmt::format("{}{:.1f}", a > 0 ? ", " : "", std::round(10.0 * p[a]) / 10.0 + 0.0);  // No minus before a zero.
  return text;
}

template std::vector<const Snapshot<2>*> chosen(const std::vector<Snapshot<2>>&);
template std::vector<const Snapshot<3>*> chosen(const std::vector<Snapshot<3>>&);
template Figure metric_figure(const std::vector<Snapshot<2>>&, const PictureFrame&);
template Figure metric_figure(const std::vector<Snapshot<3>>&, const PictureFrame&);
template std::string place_text<2>(const Vec<2>&);
template std::string place_text<3>(const Vec<3>&);

}  // namespace vantage
