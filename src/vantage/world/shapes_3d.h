// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/base/random.h"
#include "vantage/geometry/mesh.h"
#include "vantage/world/placement.h"

namespace vantage {

/// Closed curve of places, counterclockwise seen from the side towards which a loft goes; one place alone is a tip [m].
using Ring = std::vector<Vec<3>>;

/// The solid through the rings in turn: closed, facing outwards. Rings have equal counts but for tips; the first and the last are convex.
/// Every solid below but for `Blocks` is such a loft.
void add_loft(Mesh<3>& mesh, const std::vector<Ring>& rings);

/// Horizontal rectangle of the place's frame.
[[nodiscard]] Ring rectangle(const Placement<3>& place, const Box<2>& box, double z);
/// Circle of `sides` corners about `center`, across the unit vector `axis`.
[[nodiscard]] Ring circle(const Vec<3>& center, const Vec<3>& axis, double radius, int sides);

void add_box(Mesh<3>& mesh, const Placement<3>& place, const Box<3>& box);
/// From a circle about `from` to a circle about `to`.
void add_cylinder(Mesh<3>& mesh, const Vec<3>& from, const Vec<3>& to, double radius, int sides);
void add_cone(Mesh<3>& mesh, const Vec<3>& from, const Vec<3>& tip, double radius, int sides);
/// Ellipsoid with half axes `radii`, its corners moved by up to `bumps` of the radius.
void add_ball(Mesh<3>& mesh, const Vec<3>& center, const Vec<3>& radii, double bumps, Random& random);
/// Thin tube from `a` to `b` that hangs through by `sag` in the middle (the parabola that stands for a catenary).
void add_wire(Mesh<3>& mesh, const Vec<3>& a, const Vec<3>& b, double sag, double radius);
/// Solid with a triangular cross-section over `base`, its ridge at z + rise along the first axis.
void add_gable_roof(Mesh<3>& mesh, const Placement<3>& place, const Box<2>& base, double z, double rise);
/// Solid sloping on all four sides to a narrow top.
void add_hip_roof(Mesh<3>& mesh, const Placement<3>& place, const Box<2>& base, double z, double rise);
/// Level ground over `box` as an open sheet of squares of about `cell` [m].
void add_ground(Mesh<3>& mesh, const Box<2>& box, double z, double cell);

}  // namespace vantage
