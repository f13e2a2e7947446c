// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "vantage/session/result.h"

namespace vantage {

/// What a file or run folder is and holds: `{"kind": "point cloud", …}` with counts, bounds [m] and errors. Reads point clouds, surfaces, meshes,
/// maps of the plane, exchanged maps, VTK images, scan logs, scenarios and run folders. Throws io, bad_input.
[[nodiscard]] Json inspect(const std::filesystem::path& path);

}  // namespace vantage
