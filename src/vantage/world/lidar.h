// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "vantage/base/options.h"
#include "vantage/geometry/mesh.h"
#include "vantage/scan/scan.h"

namespace vantage {

/// Imperfections of the simulated scanner; all off by default.
struct LidarOptions {
  ScanPattern pattern;
  double range_noise = 0.0;  ///< Standard deviation [m].
  double dropout = 0.0;      ///< Share of the rays that give no data [1].
  double outliers = 0.0;     ///< Share of the hits put at a random shorter range [1].
  /// Standard deviation along each axis of where the scanner stands from where it says it does; halved where it would stand in an obstacle [m].
  double pose_noise = 0.0;
  double pose_turn = 0.0;  ///< The same of its orientation about each axis [rad].
  bool confirmed = false;  ///< Drop hits that too few rays beside them confirm (confirm.h).
  bool smoothed = false;   ///< Put hits onto the planes of the hits around them (smooth.h).
  std::int64_t seed = 1;   ///< Of the imperfections.
};

void describe(LidarOptions& options, const OptionVisitor& visit);

/// LiDAR in a triangle world (3D) or among line segments (2D): the stand-in for the paper's USC Simulator.
template <int Dim>
  requires SpatialDim<Dim>
class SimulatedLidar final : public Sensor<Dim> {
 public:
  SimulatedLidar(const Mesh<Dim>& world, const LidarOptions& options);
  ~SimulatedLidar() override;
  /// Throws bad_input when the place is inside an obstacle or within 1 mm of a surface; but after the first scan, with noise of pose or range, the
  /// scan is taken at the nearest open place then, and says that it was taken at `vantage_point`.
  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>& vantage_point, int index) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
