// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/geometry/angle.h"
#include "vantage/geometry/vec.h"

namespace vantage {

/// How rays leave a spinning scanner (paper Sec. V, VI). In 3D a column is a vertical line of `rows` rays; in 2D there is one row.
struct ScanPattern {
  double step = radians(0.5);            ///< Between neighbouring rays, both ways [rad].
  double horizontal_fov = 2.0 * kPi;     ///< Centred on the sensor's first axis [rad].
  double vertical_fov = radians(179.5);  ///< Centred on the horizon [rad]; 3D only.
  double min_range = 0.0;                ///< Nearer surfaces give no data [m].
  double max_range = 80.0;               ///< Farther surfaces give no return [m].

  [[nodiscard]] bool full_circle() const { return horizontal_fov > 2.0 * kPi - 0.5 * step; }
  [[nodiscard]] int columns() const;  ///< 720 for the paper's sensor.
  template <int Dim>
  [[nodiscard]] int rows() const;                  ///< 360 for the paper's sensor; 1 in 2D.
  [[nodiscard]] double azimuth(int column) const;  ///< [rad], -fov/2 .. fov/2, a full circle starts at -pi.
  [[nodiscard]] double elevation(int row) const;   ///< [rad], lowest first.
  [[nodiscard]] bool operator==(const ScanPattern&) const = default;
};

void describe(ScanPattern& pattern, const OptionVisitor& visit);

/// Range of a ray that met nothing up to the maximum range: free all the way.
inline constexpr float kNoReturn = std::numeric_limits<float>::infinity();
/// Range of a ray not fired, or invalid: nothing is known along it.
inline constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

/// One scan: the pose and, per fired ray, a range, kNoReturn or kNoData.
template <int Dim>
  requires SpatialDim<Dim>
struct Scan {
  Vec<Dim> origin = Vec<Dim>::Zero();                                                               ///< Vantage point [m].
  Eigen::Matrix<double, Dim, Dim> world_from_sensor = Eigen::Matrix<double, Dim, Dim>::Identity();  ///< Rotation.
  ScanPattern pattern;
  std::vector<float> ranges;  ///< (columns, rows), rows fastest [m].
  /// The points of a person's scan as they were measured, when the ranges are an image made from them (bin_points.h), (N, Dim) [m]. Else empty.
  std::vector<Vec<Dim>> points;

  [[nodiscard]] float range(int column, int row) const { return ranges[static_cast<std::size_t>(column * pattern.rows<Dim>() + row)]; }
};

/// Unit directions in the sensor frame, (columns * rows, Dim), rows fastest.
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> directions(const ScanPattern& pattern);

/// World positions of the hits, in the order of the rays, or the measured points if the scan keeps them, (hits, Dim) [m].
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> hit_points(const Scan<Dim>& scan);

/// The scanner: simulated, or a person's.
template <int Dim>
  requires SpatialDim<Dim>
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Scan taken at `vantage_point`, the `index`-th of the run (it seeds the noise). Throws bad_input when the place is inside an obstacle.
  [[nodiscard]] virtual Scan<Dim> scan(const Vec<Dim>& vantage_point, int index) = 0;
};

}  // namespace vantage
