// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/opening.h"
#include "vantage/planner/planner_options.h"

namespace vantage {

/// A piece of the boundary of the occlusion set, as the paper's sum sees it.
template <int Dim>
struct BoundaryElement {
  Vec<Dim> place;     ///< y [m]
  Vec<Dim> normal;    ///< grad psi: into the seen space [1].
  double area = 0.0;  ///< delta(psi) h^d, or the area of a face [m^(Dim-1)].
};

/// The elements of Eq. (1) as the options want them: one per face, or smeared over |psi| < 2 h; all of the boundary (as printed, where omega_O is
/// identically 1), without the known surface, or also without what was looked at frontally before.
template <int Dim>
[[nodiscard]] std::vector<BoundaryElement<Dim>> boundary_elements(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces,
                                                                  const PlannerOptions& options);

/// E(z) of Eq. (1), facing, normalisation, tau and line of sight by the options, w by `rays` [m^(Dim-1)]. Cost: one term an element.
template <int Dim>
[[nodiscard]] double boundary_metric(std::span<const BoundaryElement<Dim>> elements, const RayMarch<Dim>& rays, const Vec<Dim>& z,
                                     const PlannerOptions& options);

}  // namespace vantage
