// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "vantage/io/occupancy_map.h"
#include "vantage/world/scene.h"

namespace vantage {

/// Walls, domain and start of a plan. The domain is the free cells' box; the start is the middle of the widest place of the largest part that hangs
/// together for a disc of the scene's clearance. Throws bad_input, naming `where`, when no cell is free.
[[nodiscard]] Scene<2> map_scene(const OccupancyMap& map, const std::string& name, const std::string& where);

}  // namespace vantage
