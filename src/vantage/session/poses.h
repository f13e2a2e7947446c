// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/geometry/vec.h"

namespace vantage {

/// Where one scan was taken, as a list of poses has it.
struct FilePose {
  std::string name;                               ///< First column if it is no part of the pose: a file's name without its end, or a time.
  Vec<3> position = Vec<3>::Zero();               ///< [file's unit]
  std::optional<Eigen::Quaterniond> orientation;  ///< World from sensor, of unit length; none: only places are given.
};

/// A list of poses, one a line, numbers apart by commas or blanks; lines that begin with # and empty ones do not count. What the columns are is said
/// by a header (x,y,z or tx,ty,tz; qw,qx,qy,qz; r00 .. r22; m00 .. m23; any other name: the name of the scan, if it comes first, else nothing) or
/// else follows from their number:
///
///     3   x y z                          8   t x y z qx qy qz qw (TUM)
///     4   name x y z                    12   3 x 4, row by row (KITTI)
///     7   x y z qw qx qy qz             13   name, 3 x 4
///                                       16   4 x 4, row by row; also as four lines of four numbers, which are one pose
///
/// Throws io, or bad_input naming `FILE:LINE`: other columns, numbers that are not finite, a rotation that is none.
[[nodiscard]] std::vector<FilePose> read_poses(const std::filesystem::path& path);
/// The same from memory.
[[nodiscard]] std::vector<FilePose> parse_poses(std::string_view text, const std::string& where);

}  // namespace vantage
