// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/audit/reference.h"
#include "vantage/base/random.h"
#include "vantage/geometry/patch.h"
#include "vantage/world/scene.h"

namespace vantage {

struct WallOptions {
  std::int64_t places = 10000;  ///< Drawn on the true surface; those that cannot be seen are left out.
  double cosine = 0.1;          ///< Between line of sight and normal, either side: a flatter look does not count [1].
  std::int64_t seed = 1;        ///< Of the choice of places.
  bool clutter = false;         ///< Parts named tree, vehicle, furniture, pole, wire, fence, railing count too: not walls, but all surface.
};

void describe(WallOptions& options, const OptionVisitor& visit);

/// The surface twin of the reference set: the true surface inside the domain that some reachable place sees, by places drawn evenly on it.
template <int Dim>
  requires SpatialDim<Dim>
struct Walls {
  double cosine = 0.1, range = 80.0;      ///< What counts as seen [1], [m].
  double area = 0.0;                      ///< Of the surface that can be seen [m^(Dim-1)].
  std::vector<Vec<Dim>> places, normals;  ///< On it; all stand for equal areas.
  std::vector<Vec<Dim>> views;            ///< For each a reachable node that sees it.

  /// Is place k in line of sight from there, near and frontal enough?
  [[nodiscard]] bool sees(const RayCaster<Dim>& truth, const Vec<Dim>& from, std::size_t k) const;
};

/// Places are drawn one from each of equally large stretches of the surface, facet by facet. A place counts if along one of the reference's fixed
/// rays from it there stands a reachable node that sees it. Cost: a few rays for a place that can be seen, all rays for one that is hidden. Same
/// bits for any number of threads.
template <int Dim>
[[nodiscard]] Walls<Dim> reachable_walls(const Reference<Dim>& reference, const Scene<Dim>& scene, const RayCaster<Dim>& truth,
                                         const WallOptions& options = {});

/// Share of the walls seen after each of the scans [1]; empty without walls.
template <int Dim>
[[nodiscard]] std::vector<double> walls_seen(const Walls<Dim>& walls, const RayCaster<Dim>& truth, std::span<const Vec<Dim>> scans);

/// A place of a segment (2D) or triangle (3D), evenly drawn.
template <int Dim>
[[nodiscard]] Vec<Dim> place_on(const Patch<Dim>& simplex, Random& random);

}  // namespace vantage
