// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/clouds.h"

#include <fmt/format.h>

#include "vantage/base/error.h"
#include "vantage/io/point_cloud_file.h"
#include "vantage/io/scan_file.h"
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

/// A scan's points without those that the filter takes out.
ScannedPoints<3> filtered(std::vector<Vec<3>> points, const Pose<3>& pose, double step, const FilterOptions& filter, FilterReport& report) {
  const FilterReport one = filter_points(points, pose, step, filter);
  report.points += one.points;
  report.mixed += one.mixed;
  report.isolated += one.isolated;
  return {std::move(points), {}};
}

std::vector<ScannedPoints<3>> filtered_file(const fs::path& path, const FilterOptions& filter, FilterReport& report) {
  std::vector<ScannedPoints<3>> scans;
  for (const MeasuredScan& scan : read_scan_file(path)) {
    require(scan.dim == 3, "a scan of a plane: --filter is for scans of space", scan.name);
    require(scan.position.has_value(), "the file does not say where the scan was taken: --filter needs the scanner's place", scan.name);
    const Pose<3> pose{*scan.position, scan.orientation.toRotationMatrix()};
    std::vector<Vec<3>> local;
    for (const Vec<3>& p : scan.points) local.push_back(pose.world_from_sensor.transpose() * (p - pose.position));
    scans.push_back(filtered(scan.points, pose, estimate_step<3>(local), filter, report));
  }
  return scans;
}

std::vector<ScannedPoints<3>> filtered_log(const fs::path& path, const FilterOptions& filter, FilterReport& report) {
  require(scan_log_dim(path) == 3, "scans of a plane: --filter is for scans of space", path.string());
  const ScanLog<3> log = ScanLog<3>::open_to_read(path);
  std::vector<ScannedPoints<3>> scans;
  for (int i = 0; i < log.size(); ++i) {
    const Scan<3> scan = log.read(i);
    scans.push_back(filtered(hit_points(scan), {scan.origin, scan.world_from_sensor}, scan.pattern.step, filter, report));
    scans.back().sensor = SurfaceSensor<3>{scan.origin, scan.pattern.step};
  }
  return scans;
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

AnyScans read_scans(std::span<const fs::path> paths, const FilterOptions& filter, FilterReport* report) {
  if (filter.what == FilterOptions::What::none) return read_scans(paths);
  require(!paths.empty(), "no point cloud is named");
  std::vector<ScannedPoints<3>> all;
  FilterReport sum;
  for (fs::path path : paths) {
    if (is_run_folder(path)) path /= run_file::kScanLog;
    for (ScannedPoints<3>& scan : path.extension() == ".log" ? filtered_log(path, filter, sum) : filtered_file(path, filter, sum))
      all.push_back(std::move(scan));
  }
  if (report != nullptr) *report = sum;
  return all;
}

}  // namespace vantage
