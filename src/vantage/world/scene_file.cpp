// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/scene_file.h"

#include <string>

#include "vantage/base/error.h"

namespace vantage {

AnyScene load_scene_file(std::string_view spec_or_path, const SceneFileOptions&) {
  throw Error(ErrorCode::io, "no reader for this kind of file", std::string(spec_or_path));
}

}  // namespace vantage
