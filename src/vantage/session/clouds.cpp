// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/clouds.h"

#include <fmt/format.h>

#include "vantage/base/error.h"
#include "vantage/io/point_cloud_file.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scan_log.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

template <int Dim>
AnyPoints log_points(const fs::path& path) {
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(path);
  std::vector<Vec<Dim>> points;
  for (int i = 0; i < log.size(); ++i) {
    const std::vector<Vec<Dim>> more = hit_points(log.read(i));
    points.insert(points.end(), more.begin(), more.end());
  }
  return points;
}

AnyPoints cloud_points(const fs::path& path) {
  PointCloud cloud = read_points(path);
  if (cloud.dim == 3) return std::move(cloud.points);
  std::vector<Vec<2>> points;
  for (const Vec<3>& p : cloud.points) points.push_back(p.head<2>());
  return points;
}

AnyPoints read_one(fs::path path) {
  if (is_run_folder(path)) path /= run_file::kScanLog;
  if (path.extension() != ".log") return cloud_points(path);
  return scan_log_dim(path) == 2 ? log_points<2>(path) : log_points<3>(path);
}

}  // namespace

AnyPoints read_clouds(std::span<const fs::path> paths) {
  require(!paths.empty(), "no point cloud is named");
  AnyPoints all = read_one(paths.front());
  for (const fs::path& path : paths.subspan(1)) {
    const AnyPoints more = read_one(path);
    require(more.index() == all.index(), fmt::format("a cloud of {} dimensions beside one of {}", 2 + more.index(), 2 + all.index()), path.string());
    std::visit(
        [&]<class Points>(Points& points) {
          const Points& added = std::get<Points>(more);
          points.insert(points.end(), added.begin(), added.end());
        },
        all);
  }
  return all;
}

}  // namespace vantage
