// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/field/field.h"
#include "vantage/geometry/mesh.h"
#include "vantage/report/raster.h"

namespace vantage {

/// The colour of a surface under a sun over the viewer's left shoulder; both sides are alike.
[[nodiscard]] Rgb lit(const Vec<3>& normal, const Camera& camera, Rgb colour);

/// Draws the facets of a mesh, each in its colour, lit.
void draw_mesh(Raster& raster, const Mesh<3>& mesh, std::span<const Rgb> colours);

/// Quadrangles between the seen and the rest.
struct LevelSurface {
  struct Quad {
    std::array<std::uint32_t, 4> corners;
    bool known = false;  ///< It lies on what was taken for an obstacle; else on the shadow boundary.
  };
  std::vector<Vec<3>> vertices;  ///< [m]
  std::vector<Quad> quads;
};

/// The boundary of the occlusion set S = {psi <= 0} within the lattice, by surface nets (Gibson 1998): one vertex in every cell that it crosses,
/// `relaxed` so many times towards its neighbours within the cell.
[[nodiscard]] LevelSurface level_surface(const Field<3>& psi, const Field<3, NodeState>& state, int relaxed = 2);

/// Draws it: known surface in `known`, shadow boundary in `unseen`, lit.
void draw_level(Raster& raster, const LevelSurface& surface, Rgb known, Rgb unseen);

}  // namespace vantage
