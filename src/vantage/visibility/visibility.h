// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "vantage/base/options.h"
#include "vantage/field/field.h"
#include "vantage/field/seen_set.h"
#include "vantage/geometry/patch.h"
#include "vantage/scan/scan.h"
#include "vantage/visibility/depth_image.h"

namespace vantage {

/// How lines of sight are tested (paper Sec. IV-B).
struct VisibilityOptions {
  bool range_image = true;  ///< The scan's own ranges hide what lies behind them (least of the 2 x 2 rays around a direction).
  bool patches = true;      ///< The known surface hides too, each patch widened by `eta`.
  double cone_angle = 0.0;  ///< Full opening of the cone that replaces a ray against patches [rad]; 0: plain rays; the paper's is 0.0175.
};

void describe(VisibilityOptions& options, const OptionVisitor& visit);

/// First occluder in every direction from where `scan` was taken, widened and lowered as the options say. Pixels are at most half a ray step, and
/// half a cell at the farthest node of `window` (but 64 to 1024 along each edge of a face).
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] DepthImage<Dim> depth_image(std::span<const Patch<Dim>> patches, const Scan<Dim>& scan, const Grid<Dim>& window, double eta,
                                          const VisibilityOptions& options = {});

/// The nodes of `window` that are seen from where `scan` was taken: where visibility() is positive, without the distances. Not fired, not returned
/// and missing rays count as scan.h says. Cost: the depth image, then in proportion to the area of the boundary. Same bits for any number of threads.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] SeenSet<Dim> seen_by(std::span<const Patch<Dim>> patches, const Scan<Dim>& scan, const Grid<Dim>& window, double eta,
                                   const VisibilityOptions& options = {});

/// Level set of what is seen from where `scan` was taken, one value per node of `window` [m]: +max(0, d - eta) where seen, -max(0, d - eta)
/// where not, d the distance to the nearest patch; the least positive float marks a seen node within eta. Cost: seen_by() and the distances.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> visibility(std::span<const Patch<Dim>> patches, const Scan<Dim>& scan, const Grid<Dim>& window, double eta,
                                    const VisibilityOptions& options = {});

}  // namespace vantage
