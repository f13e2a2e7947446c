// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/scan_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "vantage/base/error.h"
#include "vantage/io/scan_writers.h"

namespace vantage {
namespace {

WrittenScans scans_as_xyz(std::span<const MeasuredScan> scans) {
  const int dim = common_dim(scans);
  WrittenScans written{.bytes = {}, .precision = "all digits", .left_out = {}};
  for (const MeasuredScan& scan : scans)
    for (const Vec<3>& p : scan.points) fmt::format_to(std::back_inserter(written.bytes), "{}\n", fmt::join(p.data(), p.data() + dim, " "));
  return written;
}

/// Several scans get a column with their number, from 0.
WrittenScans scans_as_csv(std::span<const MeasuredScan> scans) {
  const int dim = common_dim(scans);
  WrittenScans written{.bytes = dim == 2 ? "x,y" : "x,y,z", .precision = "all digits", .left_out = {}};
  written.bytes += scans.size() > 1 ? ",scan\n" : "\n";
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::string tail = scans.size() > 1 ? fmt::format(",{}", k) : "";
    for (const Vec<3>& p : scans[k].points)
      fmt::format_to(std::back_inserter(written.bytes), "{}{}\n", fmt::join(p.data(), p.data() + dim, ","), tail);
  }
  return written;
}

std::string counted(std::int64_t count, std::string_view one, std::string_view many) { return fmt::format("{} {}", count, count == 1 ? one : many); }

/// Whether files of its format hold more of a point than its place.
bool has_attributes(const MeasuredScan& scan) {
  constexpr std::string_view kWith[] = {"LAS", "PTX", "KITTI", "E57"};
  return std::any_of(std::begin(kWith), std::end(kWith), [&](std::string_view format) { return scan.format.starts_with(format); });
}

/// What only the scans, not the format's writer, can tell.
std::vector<std::string> losses(std::string_view format, std::span<const MeasuredScan> scans) {
  const bool keeps_pose = format == "PCD" && scans.size() == 1;
  std::int64_t poses = 0, no_return = 0, not_finite = 0;
  for (const MeasuredScan& scan : scans) {
    poses += scan.position.has_value() && !keeps_pose;
    not_finite += scan.not_finite;
    if (scan.rays) no_return += std::count(scan.rays->point.begin(), scan.rays->point.end(), RayTable::kNoReturn);
  }
  std::vector<std::string> out;
  if (poses > 0) out.push_back(counted(poses, "pose", "poses"));
  if (no_return > 0) out.push_back(counted(no_return, "ray without return", "rays without return"));
  if (scans.size() > 1 && format != "LAS" && format != "CSV") out.push_back(fmt::format("which of the {} scans a point is of", scans.size()));
  if (not_finite > 0) out.push_back(counted(not_finite, "point that is not finite", "points that are not finite"));
  if (std::any_of(scans.begin(), scans.end(), has_attributes)) out.emplace_back("what a point has beside its place (intensity, colour …)");
  return out;
}

WrittenScans written_as(std::string_view format, std::span<const MeasuredScan> scans, const ScanWriteOptions& options) {
  if (format == "PLY") return scans_as_ply(scans, options);
  if (format == "PCD") return scans_as_pcd(scans, options);
  if (format == "LAS") return scans_as_las(scans, options);
  if (format == "XYZ") return scans_as_xyz(scans);
  require(format == "CSV", fmt::format("{}: must be PLY, PCD, LAS, XYZ or CSV", format));
  return scans_as_csv(scans);
}

}  // namespace

int common_dim(std::span<const MeasuredScan> scans) {
  return !scans.empty() && std::all_of(scans.begin(), scans.end(), [](const MeasuredScan& scan) { return scan.dim == 2; }) ? 2 : 3;
}

std::size_t point_count(std::span<const MeasuredScan> scans) {
  std::size_t count = 0;
  for (const MeasuredScan& scan : scans) count += scan.points.size();
  return count;
}

std::optional<std::string_view> written_scan_format(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> kEndings[] = {{".ply", "PLY"}, {".pcd", "PCD"}, {".las", "LAS"}, {".xyz", "XYZ"},
                                                                        {".txt", "XYZ"}, {".asc", "XYZ"}, {".csv", "CSV"}};
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [ending, format] : kEndings)
    if (lower.ends_with(ending)) return format;
  return std::nullopt;
}

WrittenScans scans_as(std::string_view format, std::span<const MeasuredScan> scans, const ScanWriteOptions& options) {
  WrittenScans written = written_as(format, scans, options);
  std::vector<std::string> more = losses(format, scans);
  written.left_out.insert(written.left_out.end(), more.begin(), more.end());
  return written;
}

}  // namespace vantage
