// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/spacing.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"

namespace vantage {
namespace {

constexpr double kGrazing = 0.05;  ///< Cosine of the incidence below which it is taken for this.

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
std::uint32_t SensorSpacing<Dim>::number(const SurfaceSensor<Dim>& sensor) {
  require(sensor.position.allFinite() && sensor.step > 0.0, "surface.spacing = sensor: a scan needs its position and a step > 0 [rad]");
  const auto same = [&](const SurfaceSensor<Dim>& other) { return other.position == sensor.position && other.step == sensor.step; };
  const auto found = std::find_if(sensors_.begin(), sensors_.end(), same);
  const auto number = static_cast<std::uint32_t>(found - sensors_.begin());
  require(number < kMostScans, "surface.spacing = sensor: more than " + std::to_string(kMostScans) + " scans");
  if (found == sensors_.end()) sensors_.push_back(sensor);
  return number;
}

template <int Dim>
  requires SpatialDim<Dim>
template <class Cosine>
double SensorSpacing<Dim>::least(std::span<const Site<Dim>> sites, const Vec<Dim>& place, const Cosine& cosine) const {
  double least = most_;
  thread_local std::vector<char> asked;
  asked.assign(sensors_.size(), 0);
  for (const Site<Dim>& site : sites) {
    const std::uint32_t scan = scan_of(site);
    if (asked[scan] != 0) continue;
    asked[scan] = 1;
    const Vec<Dim> ray = place - sensors_[scan].position;
    const double range = ray.norm();
    const double incidence = range > 0.0 ? std::max(kGrazing, cosine(ray / range)) : 1.0;
    least = std::min(least, factor_ * range * sensors_[scan].step / incidence);
  }
  return least;
}

template <int Dim>
  requires SpatialDim<Dim>
double SensorSpacing<Dim>::on_plane(std::span<const Site<Dim>> sites, const Vec<Dim>& place, const Vec<Dim>& normal) const {
  return least(sites, place, [&](const Vec<Dim>& ray) { return std::abs(ray.dot(normal)); });
}

template <int Dim>
  requires SpatialDim<Dim>
double SensorSpacing<Dim>::on_line(std::span<const Site<Dim>> sites, const Vec<Dim>& place, const Vec<Dim>& along) const {
  return least(sites, place, [&](const Vec<Dim>& ray) {
    const double cosine = ray.dot(along);
    return std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  });
}

template <int Dim>
  requires SpatialDim<Dim>
double SensorSpacing<Dim>::at_most(std::span<const Site<Dim>> sites, const Vec<Dim>& place) const {
  return least(sites, place, [](const Vec<Dim>&) { return kGrazing; });
}

template class SensorSpacing<2>;
template class SensorSpacing<3>;

}  // namespace vantage
