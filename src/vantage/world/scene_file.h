// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "vantage/world/scene.h"

namespace vantage {

/// A scene read from a mesh file or a 2D occupancy map; the same conditions and errors as `make_scene`.
[[nodiscard]] AnyScene load_scene_file(std::string_view spec_or_path, const SceneFileOptions& options);

}  // namespace vantage
