// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "vantage/io/point_cloud_file.h"

namespace vantage {

/// Point Cloud Library format, version 0.7: ascii, binary, binary_compressed. Throws bad_input naming `where:line` or `where:offset`.
[[nodiscard]] PointCloud parse_pcd(std::string_view bytes, std::string_view where);

/// The vertices of a PLY. Throws bad_input naming `where:line` or `where:offset`. (Like the others here, it does not fill `not_finite`.)
[[nodiscard]] PointCloud parse_ply_points(std::string_view bytes, std::string_view where);

/// Lines of numbers between blanks, tabs, commas or semicolons; `#` and `//` begin comments. A first line of words names the columns (x, y, z
/// are looked for), else the first three are taken; two columns make a plane cloud. Throws bad_input naming `where:line`.
[[nodiscard]] PointCloud parse_xyz(std::string_view bytes, std::string_view where);

}  // namespace vantage
