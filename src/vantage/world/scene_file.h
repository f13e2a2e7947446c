// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "vantage/world/scene.h"

namespace vantage {

/// The scene of a mesh file, of several joined by `+` (`town.ply+ground.obj`), or of a 2D occupancy map (`.yaml` of ROS, PNG, PGM). Named after the
/// first; one part a file. Lattice, tolerance, range and clearance follow from the size; the start is a free place found by looking around (see
/// find_start, or in a map the middle of its widest part). Throws as make_scene.
[[nodiscard]] AnyScene load_scene_file(const std::filesystem::path& spec, const SceneFileOptions& options = {});

/// The number of the series 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is nearest in ratio to `value` > 0.
[[nodiscard]] double nice_number(double value);

}  // namespace vantage
