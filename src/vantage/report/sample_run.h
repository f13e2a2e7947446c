// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include "vantage/base/random.h"
#include "vantage/geometry/angle.h"
#include "vantage/report/report.h"

/// A small made-up run among boxes, for the tests: points, patches, states and cuts that fit together.
namespace vantage::sample {

struct Size {
  double spacing = 2.0;     ///< Of the lattice [m].
  double step = 3.0;        ///< Between rays [degrees].
  double piece = 4.0;       ///< Side of a patch [m].
  int boxes = 8, scans = 6;
  int picture_width = 420;  ///< [pixels]
};

template <int Dim>
Vec<Dim> corner(double x, double y, double z) {
  return Vec<3>(x, y, z).head<Dim>();
}

template <int Dim>
std::vector<Box<Dim>> make_boxes(int count) {
  std::vector<Box<Dim>> boxes;
  Random random(7);
  for (int k = 0; k < count; ++k) {
    const double x = 12.0 + 24.0 * (k % 5) + random.uniform(-4.0, 4.0), y = 12.0 + 20.0 * (k / 5) + random.uniform(-3.0, 3.0);
    const Vec<3> size(random.uniform(5.0, 14.0), random.uniform(4.0, 11.0), random.uniform(3.0, 12.0));
    boxes.push_back({corner<Dim>(x, y, 0.0), corner<Dim>(x + size.x(), y + size.y(), size.z())});
  }
  return boxes;
}

/// Range to the box along a ray, infinite without a meeting.
template <int Dim>
double range_to(const Box<Dim>& box, const Vec<Dim>& origin, const Vec<Dim>& direction) {
  double enter = 0.0, leave = kInfinity;
  for (int a = 0; a < Dim; ++a) {
    if (std::abs(direction[a]) < 1e-12) {
      if (origin[a] < box.low[a] || origin[a] > box.high[a]) return kInfinity;
      continue;
    }
    const double t0 = (box.low[a] - origin[a]) / direction[a], t1 = (box.high[a] - origin[a]) / direction[a];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave ? enter : kInfinity;
}

template <int Dim>
std::vector<Vec<Dim>> scan_at(const std::vector<Box<Dim>>& boxes, const Box<Dim>& domain, const Vec<Dim>& origin, double step) {
  std::vector<Vec<Dim>> points;
  const double low = Dim == 3 ? -80.0 : 0.0, high = Dim == 3 ? 80.0 : 0.0;
  for (double elevation = low; elevation <= high; elevation += step) {
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += step) {
      const auto [se, ce] = sin_cos(radians(elevation));
      const auto [sa, ca] = sin_cos(radians(azimuth));
      const Vec<Dim> direction = corner<Dim>(ca * ce, sa * ce, se);
      double range = Dim == 3 && se < 0.0 ? -origin[Dim - 1] / se : kInfinity;
      for (const Box<Dim>& box : boxes) range = std::min(range, range_to(box, origin, direction));
      if (range < 60.0 && domain.grown(0.01).contains(origin + range * direction)) points.push_back(origin + range * direction);
    }
  }
  return points;
}

/// All faces of a box in pieces.
template <int Dim>
void add_pieces(const Box<Dim>& box, double side, std::vector<Patch<Dim>>& patches) {
  for (int axis = 0; axis < Dim; ++axis) {
    const int u = (axis + 1) % Dim, v = (axis + 2) % Dim;
    const int nu = std::max(1, static_cast<int>(box.size()[u] / side)), nv = Dim == 3 ? std::max(1, static_cast<int>(box.size()[v] / side)) : 1;
    for (int face = 0; face < 2; ++face) {
      for (int i = 0; i < nu * nv; ++i) {
        Patch<Dim> patch;
        patch.count = Dim == 3 ? 4 : 2;
        for (int k = 0; k < patch.count; ++k) {
          Vec<Dim> p = box.low;
          p[axis] = face == 0 ? box.low[axis] : box.high[axis];
          p[u] += box.size()[u] * (i % nu + (k == 1 || k == 2)) / nu;
          if (Dim == 3) p[v] += box.size()[v] * (i / nu + (k >= 2)) / nv;
          patch.vertices[static_cast<std::size_t>(k)] = p;
        }
        patches.push_back(patch);
      }
    }
  }
}

template <int Dim>
bool sees(const std::vector<Box<Dim>>& boxes, const Vec<Dim>& from, const Vec<Dim>& to) {
  const double length = (to - from).norm();
  if (length < 1e-9) return true;
  return length < 60.0 && std::none_of(boxes.begin(), boxes.end(), [&](const Box<Dim>& box) { return range_to<Dim>(box, from, (to - from) / length) < length; });
}

template <int Dim>
NodeState state_of(const std::vector<Box<Dim>>& boxes, std::span<const Vec<Dim>> stations, const Vec<Dim>& p, double h) {
  for (const Box<Dim>& box : boxes) {
    if (box.contains(p)) return box.grown(-h).contains(p) ? NodeState::unseen : NodeState::obstacle;
  }
  for (const Vec<Dim>& station : stations) {
    if (sees(boxes, station, p)) return NodeState::seen;
  }
  return NodeState::unseen;
}

template <int Dim>
Snapshot<Dim> make_snapshot(const std::vector<Box<Dim>>& boxes, const std::vector<Vec<Dim>>& stations, int step, const Grid<Dim>& window) {
  Snapshot<Dim> cut;
  cut.step = step;
  cut.height = Dim == 3 ? 2.0 : 0.0;
  cut.vantage.assign(stations.begin(), stations.begin() + step + 1);
  cut.has_next = static_cast<std::size_t>(step) + 1 < stations.size();
  if (cut.has_next) cut.next = stations[static_cast<std::size_t>(step) + 1];
  Grid<2> plane{window.spacing, window.first.template head<2>(), window.extent.template head<2>()};
  cut.state = Field<2, NodeState>(plane);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const Vec<2> p = plane.position(i);
    cut.state[i] = state_of<Dim>(boxes, cut.vantage, corner<Dim>(p.x(), p.y(), cut.height), 0.6 * window.spacing);
  }
  const Box<2> bounds = plane.bounds();
  cut.metric = Field<2, float>(window_over(bounds, 2.0 * window.spacing), std::nanf(""));
  for (std::size_t i = 0; i < cut.metric.values.size(); ++i) {
    const Vec<2> p = cut.metric.window.position(i), q = cut.next.template head<2>();
    if (cut.has_next && state_of<Dim>(boxes, cut.vantage, corner<Dim>(p.x(), p.y(), cut.height), 1.0) == NodeState::seen) {
      cut.metric[i] = static_cast<float>(1.0 / (1.0 + 0.01 * (p - q).squaredNorm()));
    }
  }
  return cut;
}

template <int Dim>
ReportInput<Dim> run(const Size& size = {}) {
  ReportInput<Dim> input;
  input.scene = "sample";
  input.picture_width = size.picture_width;
  input.command = "vantage explore sample";
  input.settings = {{"explore.voxel", fmt::format("{} m", size.spacing)}, {"surface.eta", "0.1 m"}, {"scan.step_deg", fmt::format("{}", size.step)}};
  const int rows = (size.boxes + 4) / 5;
  input.domain = {corner<Dim>(0.0, 0.0, 0.0), corner<Dim>(132.0, 14.0 + 20.0 * rows, 24.0)};
  const std::vector<Box<Dim>> boxes = make_boxes<Dim>(size.boxes);
  const Grid<Dim> window = window_over(input.domain, size.spacing);

  Random random(3);
  std::vector<Vec<Dim>> stations;
  while (stations.size() < static_cast<std::size_t>(size.scans)) {
    const Vec<Dim> p = corner<Dim>(random.uniform(4.0, 128.0), random.uniform(3.0, 10.0 + 20.0 * rows), 2.0);
    if (std::none_of(boxes.begin(), boxes.end(), [&](const Box<Dim>& box) { return box.grown(1.0).contains(p); })) stations.push_back(p);
  }
  double seen = 0.0, way = 0.0;
  for (int k = 0; k < size.scans; ++k) {
    const Vec<Dim>& place = stations[static_cast<std::size_t>(k)];
    input.scan_points.push_back(scan_at(boxes, input.domain, place, size.step));
    if (k > 0) way = (place - stations[static_cast<std::size_t>(k) - 1]).norm();
    StepRecord<Dim> step;
    step.scan = k;
    step.vantage = place;
    step.points = static_cast<std::int64_t>(input.scan_points.back().size());
    step.new_volume = 40000.0 / ((k + 1) * (k + 1) * (k + 1));
    step.seen_volume = seen += step.new_volume;
    step.next_score = 1.3 / (1 + 0.2 * k);
    step.expected_volume = 36000.0 / ((k + 2) * (k + 2) * (k + 1.7));
    step.candidates = 500 - k;
    step.path_length = way;
    input.steps.push_back(step);
  }
  for (StepRecord<Dim>& step : input.steps) step.seen_fraction = 0.997 * step.seen_volume / seen;
  input.path = stations;

  for (const Box<Dim>& box : boxes) add_pieces(box, size.piece, input.patches);
  if (Dim == 3) {
    Box<Dim> ground = input.domain;
    ground.high[Dim - 1] = ground.low[Dim - 1];
    add_pieces(ground, size.piece, input.patches);
    input.patches.push_back(segment_patch(corner<Dim>(5.0, 4.0, 8.0), corner<Dim>(125.0, 4.0, 8.0)));
  }
  for (int k = 0; k < 200; ++k) input.patches.push_back(point_patch<Dim>(corner<Dim>(random.uniform(60.0, 64.0), random.uniform(6.0, 10.0), random.uniform(3.0, 7.0))));

  input.state = Field<Dim, NodeState>(window);
  for (std::size_t i = 0; i < window.size(); ++i) input.state[i] = state_of<Dim>(boxes, stations, window.position(i), 0.6 * size.spacing);
  for (int k = 0; k < size.scans; ++k) input.snapshots.push_back(make_snapshot<Dim>(boxes, stations, k, window));

  input.verdict = {false, "unseen space remains and no plan reaches it", 0.997, 0.9952, 0.9981, {}};
  for (const Box<Dim>& box : boxes) input.verdict.unseen.push_back({box.size().prod(), box, input.verdict.unseen.size() % 3 == 1 ? "no reachable view" : "enclosed"});
  std::stable_sort(input.verdict.unseen.begin(), input.verdict.unseen.end(), [](const auto& a, const auto& b) { return a.volume > b.volume; });
  input.surface.points = 1;
  input.surface.fits = static_cast<std::int64_t>(input.patches.size()) - 201;
  input.surface.segments = 1;
  input.surface.loose_points = 200;
  input.surface.eta = 0.1;
  input.surface.data_to_surface = 0.0981;
  input.surface.surface_to_data = 0.0874;
  return input;
}

}  // namespace vantage::sample
