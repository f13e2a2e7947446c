// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/cover/cover.h"
#include "vantage/survey/ways.h"
#include "vantage/world/scene.h"

namespace vantage {

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
  Ways<Dim> ways;
  std::vector<Vec<Dim>> candidates;
  std::vector<Demand<Dim>> demands;  ///< Those that some candidate meets; walls first.
  std::size_t walls = 0;             ///< Demands on walls.
  double each = 0.0;                 ///< Area for which a demand on a wall stands [m^(Dim-1)].
  CoverProblem problem;              ///< `need` is less than asked for where too few candidates see a demand.
};

/// Candidates are drawn one from each of equally long stretches of the nodes of the ways, with a height of those that have it up to half a spacing.
/// For every demand that fewer of them see than asked for, further such places are looked for along fixed rays from it and added; a demand without
/// any is dropped. Cost: one ray a pair within the limits. Throws bad_input if no place has the height. Same bits for any number of threads.
template <int Dim>
[[nodiscard]] SightLines<Dim> find_sight_lines(const Scene<Dim>& scene, const RayCaster<Dim>& truth, const Reference<Dim>& reference,
                                               const SurveyOptions& options);

}  // namespace vantage
