// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "vantage/scan/scan.h"

namespace vantage {

/// Gaps wider than this many sample spacings (2.5 lattice steps) stay open: a door may stand in them, for doors are three lattice steps wide.
inline constexpr double kWidest = 5.0;

/// A scan as an image of hits, in the sensor frame: columns go round a full circle.
template <int Dim>
class RangeImage {
 public:
  explicit RangeImage(const Scan<Dim>& scan)
      : scan_(scan), directions_(directions<Dim>(scan.pattern)), columns_(scan.pattern.columns()), rows_(scan.pattern.template rows<Dim>()) {}

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Index of a ray; -1 outside of the image.
  [[nodiscard]] int index(int column, int row) const {
    if (scan_.pattern.full_circle()) column = (column + columns_) % columns_;
    return column < 0 || column >= columns_ || row < 0 || row >= rows_ ? -1 : column * rows_ + row;
  }
  /// Range of a hit; infinity for anything else [m].
  [[nodiscard]] double range(int i) const {
    const double r = i < 0 ? kInfinity : static_cast<double>(scan_.ranges[static_cast<std::size_t>(i)]);
    return r > 0.0 ? r : kInfinity;  // NaN too.
  }
  [[nodiscard]] const Vec<Dim>& direction(int i) const { return directions_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Vec<Dim> point(int i) const { return range(i) * direction(i); }
  [[nodiscard]] Vec<Dim> world(const Vec<Dim>& p) const { return scan_.origin + scan_.world_from_sensor * p; }

 private:
  const Scan<Dim>& scan_;
  std::vector<Vec<Dim>> directions_;
  int columns_, rows_;
};

/// The hyperplane N . x = k as inverse ranges: 1/r = (N/k) . u.
template <int Dim>
struct InversePlane {
  Vec<Dim> slope;      ///< N / k [1/m]
  double tolerance;    ///< On 1/r [1/m]

  /// Tolerance for hits at `ranges` on a lattice of spacing h: a seventh of their spread, or a twentieth of a cell in depth.
  static double tolerance_for(std::span<const double> ranges, double h) {
    const auto [near, far] = std::minmax_element(ranges.begin(), ranges.end());
    return std::max(0.15 * (1.0 / *near - 1.0 / *far), 0.05 * h / (*near * *far));
  }
  [[nodiscard]] bool holds(const RangeImage<Dim>& image, int i) const {
    const double range = image.range(i);
    return std::isfinite(range) && std::abs(slope.dot(image.direction(i)) - 1.0 / range) <= tolerance;
  }
};

}  // namespace vantage
