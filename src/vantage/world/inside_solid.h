// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/geometry/ray_caster.h"

namespace vantage {

/// True when p lies within a closed solid of the world, told from how often rays to infinity cross its surfaces: at least four in five of the
/// level rays and, in 3D, four in five of the rising ones cross an odd number of times. Rays that fall are not asked, so ground below, as an open
/// sheet, changes nothing; open sheets elsewhere (leaves, signs) only take a few rays each; within a hollow house of solid walls rays cross evenly.
/// A room whose walls are a single closed sheet counts as solid: a soup of facets has no side that is out. Up is the last axis. Thread-safe.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] bool inside_solid(const RayCaster<Dim>& world, const Vec<Dim>& p);

}  // namespace vantage
