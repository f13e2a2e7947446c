// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "vantage/geometry/patch.h"

namespace vantage {

/// Binary glTF 2.0 (`surface.glb`) for any 3D viewer: polygons as flat triangles coloured by height, segments as lines, points, and the
/// way through the vantage points (N, Dim) [m] as a line strip. z is up here and becomes y there; places are floats about the middle of the scene.
template <int Dim>
[[nodiscard]] std::string surface_as_glb(std::span<const Patch<Dim>> patches, std::span<const Vec<Dim>> path);

}  // namespace vantage
