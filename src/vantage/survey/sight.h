// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/audit/reference.h"
#include "vantage/base/options.h"
#include "vantage/geometry/angle.h"
#include "vantage/survey/cover.h"
#include "vantage/world/scene.h"

namespace vantage {

/// What a scan must fulfil to count, and how stations are looked for.
struct SurveyOptions {
  double range = 80.0;                 ///< Farthest measurement that counts [m].
  double min_range = 0.5;              ///< Nearest one [m].
  double incidence = radians(75.0);    ///< Largest angle between the ray and the wall's normal [rad].
  double density = 0.0;                ///< Least points on a wall [1/m^(Dim-1)].
  double step = radians(0.5);          ///< Between the sensor's rays, both ways [rad].
  std::int64_t cover = 1;              ///< So many stations see each place.
  double overlap = 0.0;                ///< Share of what a station sees that one earlier station sees as well [1]; 0: not asked for.
  double height = 0.0;                 ///< Of the scanner above what is below it [m]; 0: any.
  double share = 1.0;                  ///< Of the demands that must be met [1].
  double clearance = 0.5;              ///< Of stations and paths to obstacles [m].
  double voxel = 0.5;                  ///< Spacing of the lattice of places [m].
  bool volume = false;                 ///< The free space is to be seen too.
  bool come_back = false;              ///< The tour ends where it begins.
  std::int64_t samples = 10000;        ///< Places drawn on the surface.
  std::int64_t candidates = 1500;      ///< Reachable places drawn; those that see what no other does are added.
  std::int64_t effort = 500;           ///< Of the search for fewer stations [million elementary steps].
  std::int64_t seed = 1;               ///< Of the draws and the search.
};

void describe(SurveyOptions& options, const OptionVisitor& visit);

/// Something to be seen: a side of a place on a wall, or a place in space (normal zero).
template <int Dim>
  requires SpatialDim<Dim>
struct Demand {
  Vec<Dim> place;   ///< [m]
  Vec<Dim> normal;  ///< Towards the side that is to be seen, length 1 or 0.
};

/// Both sides of `count` places on the mesh, one drawn from each of equally large pieces of it; those outside of the domain are left out. Each
/// stands for an equal area of its side.
template <int Dim>
[[nodiscard]] std::vector<Demand<Dim>> surface_demands(const Scene<Dim>& scene, std::int64_t count, std::uint64_t seed);

/// Within the limits and in line of sight. A scan from r metres away at an angle t to the normal has cos(t) / (r step)^(Dim-1) points to the unit of
/// a wall, more above and below the horizon, where the columns are closer.
template <int Dim>
[[nodiscard]] bool measures(const RayCaster<Dim>& truth, const Vec<Dim>& from, const Demand<Dim>& demand, const SurveyOptions& options);

/// Stations to choose from, and what each of them sees.
template <int Dim>
  requires SpatialDim<Dim>
struct SightLines {
  std::vector<Vec<Dim>> candidates;
  std::vector<Demand<Dim>> demands;  ///< Those that some candidate meets; walls first.
  std::size_t walls = 0;             ///< Demands on walls.
  double each = 0.0;                 ///< Area for which a demand on a wall stands [m^(Dim-1)].
  CoverProblem problem;              ///< `need` is less than asked for where too few candidates see a demand.
};

/// Candidates are drawn one from each of equally long stretches of the reachable nodes that have the height asked for. For every demand that fewer
/// of them see than asked for, reachable places are looked for along fixed rays from it and added; a demand without any is dropped. Cost: one ray a
/// pair within the limits. Throws bad_input if no place has the height. Same bits for any number of threads.
template <int Dim>
[[nodiscard]] SightLines<Dim> find_sight_lines(const Scene<Dim>& scene, const RayCaster<Dim>& truth, const Reference<Dim>& reference,
                                               const SurveyOptions& options);

}  // namespace vantage
