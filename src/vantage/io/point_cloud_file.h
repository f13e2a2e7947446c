// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/geometry/vec.h"

namespace vantage {

/// Points as a file has them, not-finite ones included; a plane file (no z column, or marked so) has dim 2 and z = 0.
struct PointCloud {
  int dim = 3;
  std::vector<Vec<3>> points;          ///< (N, 3) [file's unit]
  std::int64_t not_finite = 0;         ///< How many have a NaN or an infinity.
  std::string format;                  ///< "PLY, ascii", "PCD, binary", "text" …
  std::int64_t width = 0, height = 0;  ///< Of an organised PCD: lines of `width` points, one below the other; else 0.
  std::optional<Vec<3>> position;      ///< Of the sensor in the points' frame, where a PCD gives a VIEWPOINT other than the default.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< World from sensor.
};

/// Reads the points of any format of docs/12-files.md, several scans of a file one after the other; scan_file.h keeps them apart. A format is told
/// by the content, then the name. Of E57, PTX, LAS, KITTI and OctoMap the points that are not finite are left out but counted. Throws io, or
/// bad_input naming `FILE:OFFSET` (text: `FILE:LINE`).
[[nodiscard]] PointCloud read_points(const std::filesystem::path& path);
/// The same from memory; `where` names it in messages.
[[nodiscard]] PointCloud parse_points(std::string_view bytes, std::string_view where);

/// A binary PLY. Coordinates are floats where that keeps half a millimetre, else doubles.
template <int Dim>
[[nodiscard]] std::string points_as_ply(std::span<const Vec<Dim>> points);
/// One line `x y z` (2D: `x y`) a point, shortest digits that read back to the same number.
template <int Dim>
[[nodiscard]] std::string points_as_xyz(std::span<const Vec<Dim>> points);

}  // namespace vantage
