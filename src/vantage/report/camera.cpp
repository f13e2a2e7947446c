// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/camera.h"

#include "vantage/geometry/angle.h"

namespace vantage {

namespace {

/// Distance of the eye in diagonals of the box: long enough for calm perspective.
constexpr double kEyeDistance = 2.2;

double diagonal(const Box<3>& box) { return std::max(box.size().norm(), 1e-3); }

}  // namespace

Camera Camera::bird(const Box<3>& box, double azimuth, double elevation, const Frame& frame) {
  const auto [sin_a, cos_a] = sin_cos(azimuth);
  const auto [sin_e, cos_e] = sin_cos(elevation);
  Camera camera;
  camera.perspective_ = true;
  camera.forward_ = Vec<3>(cos_a * cos_e, sin_a * cos_e, -sin_e);
  camera.right_ = Vec<3>(sin_a, -cos_a, 0.0);
  camera.up_ = Vec<3>(cos_a * sin_e, sin_a * sin_e, cos_e);
  camera.eye_ = box.center() - camera.forward_ * (kEyeDistance * diagonal(box));
  camera.near_ = 0.2 * diagonal(box);
  camera.fit(box, frame);
  return camera;
}

Camera Camera::map(const Box<3>& box, const Frame& frame) {
  Camera camera;
  camera.eye_ = box.center() + Vec<3>::UnitZ() * (diagonal(box) + 1.0);
  camera.fit(box, frame);
  return camera;
}

void Camera::fit(const Box<3>& box, const Frame& frame) {
  Box<2> seen;
  for (int corner = 0; corner < 8; ++corner) {
    Vec<3> p;
    for (int a = 0; a < 3; ++a) p[a] = (corner >> a & 1) != 0 ? box.high[a] : box.low[a];
    const Projected q = project(p);
    seen.extend(Vec<2>(q.x, q.y));
  }
  const Vec<2> size = seen.size().cwiseMax(1e-9);
  zoom_ = std::min((frame.width - 2.0 * frame.margin) / size.x(), (frame.height - 2.0 * frame.margin) / size.y());
  width_ = std::max(1, static_cast<int>(std::ceil(size.x() * zoom_ + 2.0 * frame.margin - 1e-6)));
  height_ = std::max(1, static_cast<int>(std::ceil(size.y() * zoom_ + 2.0 * frame.margin - 1e-6)));
  shift_x_ = 0.5 * width_ - seen.center().x() * zoom_;
  shift_y_ = 0.5 * height_ - seen.center().y() * zoom_;
}

Projected Camera::project(const Vec<3>& p) const {
  const Vec<3> ray = p - eye_;
  const double distance = forward_.dot(ray);
  const double scale = perspective_ ? zoom_ / distance : zoom_;
  return {shift_x_ + scale * right_.dot(ray), shift_y_ - scale * up_.dot(ray), perspective_ ? 1.0 / distance : distance};
}

Vec<2> Camera::ground(double x, double y) const { return {eye_.x() + (x - shift_x_) / zoom_, eye_.y() - (y - shift_y_) / zoom_}; }

}  // namespace vantage
