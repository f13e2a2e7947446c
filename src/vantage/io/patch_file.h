// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vantage/geometry/patch.h"

namespace vantage {

/// A binary PLY (`surface.ply`): elements vertex (doubles x, y, z), face (polygons), edge (segments, and all patches in 2D) and point (index of
/// a vertex that stands for itself), the latter three with the certified errors data_to_surface and surface_to_data [m].
template <int Dim>
[[nodiscard]] std::string patches_as_ply(std::span<const Patch<Dim>> patches);

/// Patches of a plane or of space, whichever the file says.
using AnyPatches = std::variant<std::vector<Patch<2>>, std::vector<Patch<3>>>;

/// Reads what `patches_as_ply` wrote, or any PLY of convex faces: polygons first, then segments, then points, each in the file's order.
/// Throws bad_input for what no patch can be: corners that are not finite, indices out of range, polygons of more than 8 corners.
[[nodiscard]] AnyPatches parse_patches(std::string_view bytes, std::string_view where);
/// The same from a file; throws io as well.
[[nodiscard]] AnyPatches read_patches(const std::filesystem::path& path);

}  // namespace vantage
