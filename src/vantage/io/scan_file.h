// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/geometry/vec.h"

namespace vantage {

/// The rays of an organised scan, columns (lines of one azimuth) one after the other.
struct RayTable {
  static constexpr std::int32_t kNoReturn = -1;  ///< Fired, nothing came back.
  static constexpr std::int32_t kNoData = -2;    ///< Not fired, or invalid.
  std::int32_t columns = 0, rows = 0;
  std::vector<std::int32_t> point;  ///< Per ray the index of its point, kNoReturn or kNoData, rows fastest, (columns * rows).
  bool assumed = false;             ///< The file does not tell rays without return from those not fired: all are kNoReturn.
};

/// One scan as a file has it. A file may hold several.
struct MeasuredScan {
  std::string name;                ///< "FILE", or "FILE, scan 2 of 3".
  std::string format;              ///< "PLY, ascii", "E57" …
  int dim = 3;                     ///< 2: a plane scan, z = 0.
  std::vector<Vec<3>> points;      ///< In the file's world frame: a pose the file gives has been applied. Finite ones only, (N, 3) [file's unit].
  std::int64_t not_finite = 0;     ///< Points left out.
  std::optional<Vec<3>> position;  ///< Of the scanner in the same frame; none: the file does not say [file's unit].
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< World from sensor.
  std::optional<RayTable> rays;                                     ///< If the file keeps the order of the rays.
  std::optional<int> epsg;                                          ///< Code of a projected coordinate system, where a LAS or E57 file names one.
};

/// All scans of a point cloud file of any format of docs/12-files.md; an E57 may hold none. Throws io, or bad_input naming `FILE:OFFSET` (text:
/// `FILE:LINE`).
[[nodiscard]] std::vector<MeasuredScan> read_scan_file(const std::filesystem::path& path);
/// The same from memory; `where` names it in messages, and its ending tells what the content does not.
[[nodiscard]] std::vector<MeasuredScan> parse_scan_file(std::string_view bytes, std::string_view where);

/// "PLY", "PCD", "LAS", "E57", "PTX", "OctoMap", "KITTI" or "text": what a file is by its first bytes (4096 do), else by its name; none: neither
/// tells of points.
[[nodiscard]] std::optional<std::string_view> scan_format(std::string_view bytes, std::string_view where);

}  // namespace vantage
