// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "vantage/scan/scan.h"

namespace vantage {

/// Where a scan was taken.
template <int Dim>
struct Pose {
  Vec<Dim> position = Vec<Dim>::Zero();                                                             ///< [m]
  Eigen::Matrix<double, Dim, Dim> world_from_sensor = Eigen::Matrix<double, Dim, Dim>::Identity();  ///< Rotation.
};

/// How a cloud of points becomes a scan.
struct BinOptions {
  double step = 0.0;           ///< Angle between rays [rad]; 0: estimated from the points.
  double min_range = 0.0;      ///< Nearer points are hits of the scanner's own stand and are left out [m].
  double max_range = 80.0;     ///< Farther points are left out [m].
  bool no_return_free = true;  ///< Directions within the field of view that hit nothing are free up to max_range; false: nothing is known of them.
};

/// The rays of an organised scan: per ray the index of its point, or -1: fired, nothing came back, or -2: not fired or invalid; rows fastest.
struct RayOrder {
  int columns = 0, rows = 0;
  std::span<const std::int32_t> point;
};

/// What was made of the points; directions are rays of the image.
struct BinReport {
  double step = 0.0;                           ///< [rad]
  double lowest = 0.0, highest = 0.0;          ///< Elevations that hits cover [rad].
  std::int64_t points = 0, near = 0, far = 0;  ///< Kept, nearer than min_range, farther than max_range.
  std::int64_t hit = 0, between = 0;           ///< Directions with a hit, and without one but with hits close by on both sides.
  std::int64_t empty = 0, outside = 0;         ///< Directions without: within the field of view, and outside of it.
  bool ordered = false;                        ///< The rays of an organised scan were used, for its hits lie in their columns and rows.
};

template <int Dim>
  requires SpatialDim<Dim>
struct BinnedScan {
  Scan<Dim> scan;  ///< Keeps the points as they are; `ranges` is the image that visibility needs.
  BinReport report;
};

/// The angle between rays that fills an image best: the smallest of common ones (0.1 .. 10 degrees) at which more than half of the directions with a
/// hit have at most one empty neighbour; of a cloud too sparse for any, the largest. `points` in the sensor's frame, (N, Dim) [m].
template <int Dim>
[[nodiscard]] double estimate_step(std::span<const Vec<Dim>> points);

/// A scan out of points in the world's frame and the place it was taken from. Of several points in one direction the nearest gives the range; a
/// direction without a hit that has hits close by on both sides, along or across, lies on the surface between them: four rays from hit to hit, or
/// four times the distance between points, for a cloud thinned to even spacing is sparse in angle close by. The field of view is what hits cover:
/// elevations between the lowest and the highest with three hits or more, azimuths without a gap of 15 degrees. With `order`, the rays that came back
/// empty are free and those not fired unknown, whatever the options say, unless its hits do not lie on columns of one azimuth and rows of one
/// elevation. Throws bad_input if no point is left.
template <int Dim>
[[nodiscard]] BinnedScan<Dim> bin_points(std::span<const Vec<Dim>> points, const Pose<Dim>& pose, const BinOptions& options,
                                         const std::optional<RayOrder>& order = std::nullopt);

}  // namespace vantage
