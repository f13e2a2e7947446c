// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/surface/snap.h"
#include "vantage/surface/surface.h"

namespace vantage {

/// How far apart the rays of the scans leave points on what they hit: factor * range * step / cos(incidence).
template <int Dim>
  requires SpatialDim<Dim>
class SensorSpacing {
 public:
  /// `most` bounds every distance [m].
  SensorSpacing(double factor, double most) : factor_(factor), most_(most) {}

  /// Number of a scan, for the tags of its sites. The same sensor has the same number. `position` is from the cube's low corner.
  [[nodiscard]] std::uint32_t number(const SurfaceSensor<Dim>& sensor);
  [[nodiscard]] double most() const { return most_; }

  /// Distance between points on a plane with this normal around `place` [m], as the best scan leaves them that has any of the sites.
  [[nodiscard]] double on_plane(std::span<const Site<Dim>> sites, const Vec<Dim>& place, const Vec<Dim>& normal) const;
  /// The same along a line.
  [[nodiscard]] double on_line(std::span<const Site<Dim>> sites, const Vec<Dim>& place, const Vec<Dim>& along) const;
  /// No plane or line around `place` has a larger one [m].
  [[nodiscard]] double at_most(std::span<const Site<Dim>> sites, const Vec<Dim>& place) const;

 private:
  double factor_, most_;
  std::vector<SurfaceSensor<Dim>> sensors_;

  template <class Cosine>
  double least(std::span<const Site<Dim>> sites, const Vec<Dim>& place, const Cosine& cosine) const;
};

}  // namespace vantage
