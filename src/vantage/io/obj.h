// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "vantage/geometry/patch.h"

namespace vantage {

/// Wavefront OBJ (`surface.obj`): a vertex line a corner with all digits, then polygons as `f`, segments as `l`, points as `p`, in the order of the
/// patches. z is up; a plane lies at z = 0. OBJ has no place for the certified errors.
template <int Dim>
[[nodiscard]] std::string patches_as_obj(std::span<const Patch<Dim>> patches);

}  // namespace vantage
