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
std::vector<AnyPoints> log_points(const fs::path& path) {
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(path);
  std::vector<AnyPoints> scans;
  for (int i = 0; i < log.size(); ++i) scans.emplace_back(hit_points(log.read(i)));
  if (scans.empty()) scans.emplace_back(std::vector<Vec<Dim>>());
  return scans;
}

AnyPoints cloud_points(const fs::path& path) {
  PointCloud cloud = read_points(path);
  if (cloud.dim == 3) return std::move(cloud.points);
  std::vector<Vec<2>> points;
  for (const Vec<3>& p : cloud.points) points.push_back(p.head<2>());
  return points;
}

std::vector<AnyPoints> read_one(fs::path path) {
  if (is_run_folder(path)) path /= run_file::kScanLog;
  if (path.extension() != ".log") return {cloud_points(path)};
  return scan_log_dim(path) == 2 ? log_points<2>(path) : log_points<3>(path);
}

}  // namespace

std::vector<AnyPoints> read_scans(std::span<const fs::path> paths) {
  require(!paths.empty(), "no point cloud is named");
  std::vector<AnyPoints> all;
  for (const fs::path& path : paths)
    for (AnyPoints& scan : read_one(path)) {
      if (!all.empty())
        require(scan.index() == all[0].index(), fmt::format("a cloud of {} dimensions beside one of {}", 2 + scan.index(), 2 + all[0].index()),
                path.string());
      all.push_back(std::move(scan));
    }
  return all;
}

AnyPoints read_clouds(std::span<const fs::path> paths) {
  std::vector<AnyPoints> scans = read_scans(paths);
  std::visit(
      [&]<class Points>(Points& points) {
        for (AnyPoints& scan : std::span(scans).subspan(1)) {
          const Points& added = std::get<Points>(scan);
          points.insert(points.end(), added.begin(), added.end());
          scan = Points();
        }
      },
      scans.front());
  return std::move(scans.front());
}

}  // namespace vantage
