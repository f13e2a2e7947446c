// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/geometry/mesh.h"
#include "vantage/world/placement.h"

namespace vantage {

/// A solid made like a sculpture: boxes put on and carved out, each step over the earlier ones. A house is a filled hull with its rooms, doors
/// and windows carved out.
template <int Dim>
  requires SpatialDim<Dim>
class Blocks {
 public:
  Blocks& fill(const Box<Dim>& box);
  Blocks& carve(const Box<Dim>& box);
  /// Adds the solid's surface: closed, facing outwards, nothing inside the solid. Every edge is shared by two facets, but for an edge at which
  /// two boxes touch crosswise, shared by four.
  void append_to(Mesh<Dim>& mesh, const Placement<Dim>& place = {}) const;

 private:
  struct Step {
    Box<Dim> box;  ///< Own frame [m].
    bool solid;
  };
  std::vector<Step> steps_;
};

}  // namespace vantage
