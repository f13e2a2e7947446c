// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/field/grid.h"
#include "vantage/geometry/patch.h"
#include "vantage/scan/scan.h"

namespace vantage {

/// A piece of known surface, about a cell large or smaller.
template <int Dim>
struct SurfacePiece {
  Vec<Dim> center = Vec<Dim>::Zero();  ///< [m]
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< Unit, either side.
  double area = 0.0;                   ///< [m^(Dim-1)]
};

/// Surface that hangs together and was only ever seen flatter than a limit.
template <int Dim>
struct FlatRegion {
  double area = 0.0;       ///< [m^(Dim-1)]
  double incidence = 0.0;  ///< Between ray and normal, of the best look at each piece, mean over the area [rad].
  Box<Dim> box;            ///< [m]
};

template <int Dim>
struct FlatSurface {
  double area = 0.0;  ///< [m^(Dim-1)]
  std::vector<SurfacePiece<Dim>> pieces;
  std::vector<FlatRegion<Dim>> regions;  ///< Largest first; small ones are left out.
};

/// How frontally each place of a surface was looked at. A scan looked at a piece if one of its rays next to the piece's direction ends on the
/// piece's plane. Flat patches count, thin and single ones have no side to look at.
template <int Dim>
  requires SpatialDim<Dim>
class Incidence {
 public:
  Incidence(std::span<const Patch<Dim>> patches, const Grid<Dim>& window);

  void add(const Scan<Dim>& scan);

  /// What no scan looked at with a cosine of `least` or more although one looked at it; regions smaller than (3 h)^(Dim-1) are not listed.
  [[nodiscard]] FlatSurface<Dim> flatter(double least) const;

 private:
  Grid<Dim> window_;
  std::vector<SurfacePiece<Dim>> pieces_;
  std::vector<double> best_;  // Cosine of the best look; < 0: none.
};

}  // namespace vantage
