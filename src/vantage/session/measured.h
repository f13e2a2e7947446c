// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/scan/bin_points.h"
#include "vantage/session/point_filter.h"

namespace vantage {

/// How a person's files are read, and made into scans.
struct MeasuredOptions {
  double unit = 1.0;  ///< Of files and lists of poses [m].
  /// Axis of the files that points up; x: z to the left; y: as in most mesh files; down: z points down.
  enum class Up { x, y, z, down } up = Up::z;
  /// Frame that the points of files stand in: pose: the scanner's where the pose given has a rotation, else the world's.
  enum class Frame { pose, sensor, world } frame = Frame::pose;
  enum class NoReturn { free, unknown } no_return = NoReturn::free;
  double min_range = 0.3;  ///< [m]
  double range = 0.0;      ///< [m]; 0: by the points.
  double step = 0.0;       ///< [rad]; 0: by the points.
  FilterOptions filter;    ///< Of the points that go to the surface; the image keeps their ranges, so that nothing behind them counts as seen.
};

void describe(MeasuredOptions& options, const OptionVisitor& visit);

/// World axes from file axes, proper rotations all.
[[nodiscard]] Eigen::Matrix3d upright(MeasuredOptions::Up up);

/// Where the scans of the files were taken, if the files shall not say it.
struct GivenPoses {
  std::filesystem::path list;  ///< poses.h; in the order of the scans, or by the names of the files.
  std::vector<Vec<3>> at;      ///< One a scan [m].
};

/// A person's scan and what is to be known about it.
struct MeasuredInput {
  Scan<3> scan;
  BinReport report;
  FilterReport filtered;
  std::string name;    ///< Of the file, and which of its scans.
  std::string format;  ///< "PCD, ascii"
  std::string pose;    ///< Where the pose is from: "poses.csv", "--at", "the file".
  std::int64_t not_finite = 0;
};

/// All scans of the files (io/scan_file.h), in metres, z up, with the given poses or else those of the files. `range` is that of earlier scans; 0:
/// there are none, it is made longer where the points reach farther, half as far again as all but the farthest in a thousand. Throws io, or
/// bad_input: a malformed file, a plane scan, a scan without a pose, more or fewer poses than scans.
[[nodiscard]] std::vector<MeasuredInput> read_measured(std::span<const std::filesystem::path> files, const GivenPoses& poses,
                                                       const MeasuredOptions& options, double range);

}  // namespace vantage
