// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/inside_solid.h"

#include <algorithm>
#include <cmath>

#include "vantage/geometry/angle.h"

namespace vantage {
namespace {

constexpr int kRays = 25;                           ///< Of either kind.
constexpr double kGoldenAngle = 2.399963229728653;  ///< Spreads any number of azimuths evenly [rad].
constexpr double kStep = 1e-6;                      ///< Surfaces closer to each other than this are one [m], also relative to the range.

/// `rise` is the sine of the elevation; a plane has none.
template <int Dim>
Vec<Dim> direction(double azimuth, double rise) {
  Vec<Dim> d;
  double level = 1.0;
  for (int a = 2; a < Dim; ++a) {
    d[a] = rise;
    level = std::sqrt(1.0 - rise * rise);
  }
  const auto [s, c] = sin_cos(azimuth);
  d[0] = level * c;
  d[1] = level * s;
  return d;
}

template <int Dim>
bool crosses_oddly(const RayCaster<Dim>& world, const Vec<Dim>& p, const Vec<Dim>& along) {
  bool odd = false;
  for (double t = 0.0;; odd = !odd) {
    const double range = world.cast(p + t * along, along).range;
    if (range == kInfinity) return odd;
    t += range + kStep * std::max(1.0, t + range);
  }
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
bool inside_solid(const RayCaster<Dim>& world, const Vec<Dim>& p) {
  int level = 0, rising = 0;
  for (int i = 0; i < kRays; ++i) {
    const double tilt = i % 2 == 0 ? 0.005 : -0.005;  // Not along floors and sills at the same height.
    level += crosses_oddly<Dim>(world, p, direction<Dim>(i * kGoldenAngle, tilt)) ? 1 : 0;
    rising += crosses_oddly<Dim>(world, p, direction<Dim>((i + 0.5) * kGoldenAngle, (i + 0.5) / kRays)) ? 1 : 0;
  }
  return 5 * level >= 4 * kRays && 5 * rising >= 4 * kRays;
}

template bool inside_solid<2>(const RayCaster<2>&, const Vec<2>&);
template bool inside_solid<3>(const RayCaster<3>&, const Vec<3>&);

}  // namespace vantage
