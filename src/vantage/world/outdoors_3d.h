// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "vantage/base/random.h"
#include "vantage/world/placement.h"
#include "vantage/world/scenery.h"

namespace vantage {

// What stands in the open, on the ground at z = 0.

/// Broad-leaved tree: trunk and some round clumps of leaves about 0.3 of the height wide; kind "tree".
void add_tree(Scenery<3>& scenery, const Vec<2>& foot, double height, Random& random);
/// Tall narrow tree of stacked cones; kind "tree".
void add_fir(Scenery<3>& scenery, const Vec<2>& foot, double height, Random& random);
/// `count` trees of both sorts over an area, none nearer than about 3 m to another.
void add_grove(Scenery<3>& scenery, const Box<2>& area, int count, Random& random);

/// Car of 4.3 x 1.8 x 1.5 m, centred, along the first axis; kind "vehicle".
void add_car(Scenery<3>& scenery, const Placement<3>& place, Random& random);
/// Lorry of 7.4 x 2.4 x 3.1 m, centred, along the first axis; kind "vehicle".
void add_lorry(Scenery<3>& scenery, const Placement<3>& place);

/// Light poles of 7.5 m with a lamp ("pole"), and from each to the next three sagging wires of 10, 15 and 20 mm radius ("wire").
void add_power_line(Scenery<3>& scenery, std::span<const Vec<2>> feet);

/// Table of 1.8 x 0.8 m with a bench on either long side, centred, along the first axis; kind "furniture".
void add_table(Scenery<3>& scenery, const Placement<3>& place);
/// Bench of 1.6 m, centred, along the first axis; kind "furniture".
void add_bench(Scenery<3>& scenery, const Placement<3>& place);
/// Round basin with a pillar in it; kind "column".
void add_fountain(Scenery<3>& scenery, const Vec<2>& center);

}  // namespace vantage
