// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/scan_file.h"

#include "vantage/io/point_cloud_file.h"

namespace vantage {

std::vector<MeasuredScan> read_scan_file(const std::filesystem::path& path) {
  const PointCloud cloud = read_points(path);
  MeasuredScan scan;
  scan.name = path.string();
  scan.format = cloud.format;
  scan.dim = cloud.dim;
  for (const Vec<3>& p : cloud.points)
    if (p.allFinite()) scan.points.push_back(p);
  scan.not_finite = static_cast<std::int64_t>(cloud.points.size() - scan.points.size());
  return {scan};
}

}  // namespace vantage
