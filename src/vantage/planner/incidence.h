// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/geometry/box.h"
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

/// How frontally each place of the known surface was looked at: of the lattice faces between seen and obstacle nodes, each with its share of the
/// smooth surface's area and the normal that the states around tell. A scan looked at one if a ray next to its direction ends on its plane.
template <int Dim>
  requires SpatialDim<Dim>
class Incidence {
 public:
  explicit Incidence(const BeliefView<Dim>& view);

  void add(const Scan<Dim>& scan);

  /// What no scan looked at with a cosine of `least` or more although one looked at it; regions smaller than (3 h)^(Dim-1) are not listed.
  [[nodiscard]] FlatSurface<Dim> flatter(double least) const;

 private:
  Grid<Dim> window_;
  std::vector<SurfacePiece<Dim>> pieces_;
  std::vector<double> best_;  // Cosine of the best look; < 0: none.
};

}  // namespace vantage
