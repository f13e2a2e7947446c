// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/audit/score.h"
#include "vantage/geometry/box.h"

namespace vantage {

/// Whether this build has OctoMap; without it InformationGain throws.
[[nodiscard]] bool has_octomap();

/// What others do: goes where rays through an OctoMap of the scans so far pass most unknown voxels (2D: through a layer of it). Takes scans from
/// another sensor, and inserts each: free along its rays, up to the range where they met nothing, occupied at their ends.
template <int Dim>
  requires SpatialDim<Dim>
class InformationGain final : public Sensor<Dim>, public Pilot<Dim> {
 public:
  struct Options {
    double voxel = 0.5;        ///< Resolution of the map; its voxels have the lattice's nodes in their middle [m].
    std::int64_t rays = 4050;  ///< From every place (2D: a quarter).
  };
  /// Rays end at the border of `domain`, at an occupied voxel, or at the sensor's range. Throws bad_input without OctoMap.
  InformationGain(Sensor<Dim>& sensor, const Box<Dim>& domain, const Options& options);
  ~InformationGain() override;

  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>& vantage_point, int index) override;
  /// Of the candidates of the explorer's last decision the one with the largest gain, the first of equals; nullopt if none has any.
  [[nodiscard]] std::optional<Vec<Dim>> next(const Explorer<Dim>& explorer) override;

  /// Unknown voxels along the rays from each place, every ray for itself.
  [[nodiscard]] std::vector<std::int64_t> gains(std::span<const Vec<Dim>> places) const;

 private:
  struct Map;
  std::unique_ptr<Map> map_;
};

}  // namespace vantage
