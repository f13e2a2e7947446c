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
AnyScans log_scans(const fs::path& path) {
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(path);
  std::vector<ScannedPoints<Dim>> scans;
  for (int i = 0; i < log.size(); ++i) {
    const Scan<Dim> scan = log.read(i);
    scans.push_back({hit_points(scan), SurfaceSensor<Dim>{scan.origin, scan.pattern.step}});
  }
  return scans;
}

AnyScans cloud_scan(const fs::path& path) {
  PointCloud cloud = read_points(path);
  if (cloud.dim == 3) return std::vector<ScannedPoints<3>>{{std::move(cloud.points), {}}};
  std::vector<Vec<2>> points;
  for (const Vec<3>& p : cloud.points) points.push_back(p.head<2>());
  return std::vector<ScannedPoints<2>>{{std::move(points), {}}};
}

AnyScans read_one(fs::path path) {
  if (is_run_folder(path)) path /= run_file::kScanLog;
  if (path.extension() != ".log") return cloud_scan(path);
  return scan_log_dim(path) == 2 ? log_scans<2>(path) : log_scans<3>(path);
}

}  // namespace

AnyScans read_scans(std::span<const fs::path> paths) {
  require(!paths.empty(), "no point cloud is named");
  AnyScans all = read_one(paths.front());
  for (const fs::path& path : paths.subspan(1)) {
    AnyScans more = read_one(path);
    require(more.index() == all.index(), fmt::format("a cloud of {} dimensions beside one of {}", 2 + more.index(), 2 + all.index()), path.string());
    std::visit(
        [&]<class Scans>(Scans& scans) {
          for (auto& scan : std::get<Scans>(more)) scans.push_back(std::move(scan));
        },
        all);
  }
  return all;
}

}  // namespace vantage
