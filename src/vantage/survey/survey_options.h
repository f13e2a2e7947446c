// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/base/options.h"
#include "vantage/geometry/angle.h"

namespace vantage {

/// What a scan must fulfil to count, and how stations are looked for.
struct SurveyOptions {
  double range = 80.0;               ///< Farthest measurement that counts [m].
  double min_range = 0.5;            ///< Nearest one [m].
  double incidence = radians(75.0);  ///< Largest angle between the ray and the wall's normal [rad].
  double density = 0.0;              ///< Least points on a wall [1/m^(Dim-1)].
  double step = radians(0.5);        ///< Between the sensor's rays, both ways [rad].
  std::int64_t cover = 1;            ///< So many stations see each place.
  double overlap = 0.0;              ///< Share of what a station sees that one earlier station sees as well [1]; 0: not asked for.
  double height = 0.0;               ///< Of the scanner above what is below it [m]; 0: any, as a drone.
  double share = 1.0;                ///< Of the demands that must be met [1].
  double clearance = 0.5;            ///< Of stations and paths to obstacles [m].
  double voxel = 0.5;                ///< Spacing of the lattice of places [m].
  bool volume = false;               ///< The free space is to be seen too.
  bool come_back = false;            ///< The tour ends where it begins.
  std::int64_t samples = 10000;      ///< Places drawn on the surface.
  std::int64_t candidates = 5000;    ///< Reachable places drawn; those that see what no other does are added.
  std::int64_t effort = 500;         ///< Of the search for fewer stations [million elementary steps].
  std::int64_t seed = 1;             ///< Of the draws and the search.
};

void describe(SurveyOptions& options, const OptionVisitor& visit);

}  // namespace vantage
