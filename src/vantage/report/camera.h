// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/geometry/box.h"

namespace vantage {

/// Place in a picture: pixels from its upper left corner, and a depth that is linear over the picture.
struct Projected {
  double x = 0.0, y = 0.0;  ///< [pixels]
  double depth = 0.0;       ///< Orthographic: distance [m]; perspective: its inverse [1/m].
};

/// Largest size of a picture [pixels].
struct Frame {
  int width, height;
  double margin;  ///< Kept free around the contents.
};

/// Looks at a box so that it fills the frame; the picture takes the contents' own proportions.
class Camera {
 public:
  /// Perspective bird's view with a long lens. `azimuth` is the compass direction of the look, counter-clockwise from the first axis; `elevation` how far it
  /// looks down [rad].
  static Camera bird(const Box<3>& box, double azimuth, double elevation, const Frame& frame);
  /// Orthographic, straight down, first axis to the right.
  static Camera map(const Box<3>& box, const Frame& frame);

  [[nodiscard]] Projected project(const Vec<3>& p) const;
  /// Along the line of sight, from the depth [m].
  [[nodiscard]] double distance(double depth) const { return perspective_ ? 1.0 / depth : depth; }
  /// What one pixel covers at a distance [m].
  [[nodiscard]] double pixel_size(double distance) const { return (perspective_ ? distance : 1.0) / zoom_; }
  /// In front of the lens, where projection means something.
  [[nodiscard]] bool in_front(const Vec<3>& p) const { return forward_.dot(p - eye_) > near_; }
  /// First two coordinates of the place under a pixel; for `map` only [m].
  [[nodiscard]] Vec<2> ground(double x, double y) const;

  [[nodiscard]] const Vec<3>& forward() const { return forward_; }
  [[nodiscard]] const Vec<3>& right() const { return right_; }
  [[nodiscard]] const Vec<3>& up() const { return up_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  void fit(const Box<3>& box, const Frame& frame);

  Vec<3> eye_ = Vec<3>::Zero(), right_ = Vec<3>::UnitX(), up_ = Vec<3>::UnitY(), forward_ = -Vec<3>::UnitZ();
  double near_ = 0.0, zoom_ = 1.0;
  double shift_x_ = 0.0, shift_y_ = 0.0;
  bool perspective_ = false;
  int width_ = 1, height_ = 1;
};

}  // namespace vantage
