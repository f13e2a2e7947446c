// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/geometry/mesh.h"

namespace vantage {

/// Triangles of a polygon with holes: holes joined to the outline by bridges, then ear after ear (Eberly 2002, "Triangulation by ear clipping"), all
/// seen along the outline's mean normal. `corners` are indices into `places`, the outline first, then the holes, which begin at `holes` (ascending);
/// either way round. Rings of fewer than three corners, and holes outside of the outline, count nothing; a twisted rest becomes a fan. Appends to
/// `out`, turning as the outline does. Costs corners times reflex corners.
void cut_polygon(std::span<const Vec<3>> places, std::span<const std::uint32_t> corners, std::span<const std::size_t> holes,
                 std::vector<Mesh<3>::Facet>& out);

}  // namespace vantage
