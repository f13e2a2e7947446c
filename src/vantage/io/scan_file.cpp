// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/scan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/point_cloud_formats.h"
#include "vantage/io/scan_formats.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

bool ends_like(std::string_view name, std::string_view ending) {
  const auto same = [](char wanted, char c) { return wanted == std::tolower(static_cast<unsigned char>(c)); };
  return name.size() >= ending.size() && std::equal(ending.begin(), ending.end(), name.end() - static_cast<std::ptrdiff_t>(ending.size()), same);
}

/// The first line that is no comment begins a PCD header.
bool looks_like_pcd(std::string_view bytes) {
  TextScanner scanner(bytes.substr(0, 4096));
  while (const std::optional<std::string_view> line = scanner.next_line()) {
    std::string_view rest = *line;
    const std::string_view key = take_word(rest);
    if (key.empty() || key.front() == '#') continue;
    return (key == "VERSION" && (rest == " 0.7" || rest == " .7")) || (key == "FIELDS" && !rest.empty());
  }
  return false;
}

std::optional<std::string_view> format_of_content(std::string_view bytes) {
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return "PLY";
  if (bytes.starts_with("LASF")) return "LAS";
  if (bytes.starts_with("ASTM-E57")) return "E57";
  if (bytes.starts_with("# Octomap OcTree")) return "OctoMap";
  if (bytes.starts_with("# .PCD") || looks_like_pcd(bytes)) return "PCD";
  if (looks_like_ptx(bytes)) return "PTX";
  return std::nullopt;
}

std::optional<std::string_view> format_of_name(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> kEndings[] = {
      {".ply", "PLY"},   {".pcd", "PCD"},  {".las", "LAS"},  {".laz", "LAS"},  {".e57", "E57"},  {".ptx", "PTX"},  {".bt", "OctoMap"},
      {".bin", "KITTI"}, {".xyz", "text"}, {".csv", "text"}, {".txt", "text"}, {".pts", "text"}, {".asc", "text"}, {".dat", "text"}};
  for (const auto& [ending, format] : kEndings)
    if (ends_like(name, ending)) return format;
  return std::nullopt;
}

/// An organised cloud becomes a table of rays: a place without a point, which is not a number or all zeros, is a ray without return. (Whether it
/// was fired the file does not tell.)
void keep_rays(const PointCloud& cloud, MeasuredScan& scan) {
  RayTable rays{static_cast<std::int32_t>(cloud.width), static_cast<std::int32_t>(cloud.height), {}, true};
  rays.point.assign(scan.points.size(), RayTable::kNoReturn);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Vec<3> p = scan.points[i];
    const bool finite = p.allFinite();
    scan.not_finite += !finite;
    if (!finite || p.isZero(0.0)) continue;
    const auto line = i / static_cast<std::size_t>(cloud.width), column = i % static_cast<std::size_t>(cloud.width);
    rays.point[column * static_cast<std::size_t>(cloud.height) + line] = static_cast<std::int32_t>(kept);
    scan.points[kept++] = p;
  }
  scan.points.resize(kept);
  scan.rays = std::move(rays);
  scan.format += fmt::format(", {} x {} rays", cloud.width, cloud.height);
}

std::vector<MeasuredScan> scan_of_cloud(PointCloud cloud) {
  MeasuredScan scan;
  scan.format = std::move(cloud.format);
  scan.dim = cloud.dim;
  scan.points = std::move(cloud.points);
  scan.position = cloud.position;
  scan.orientation = cloud.orientation;
  if (cloud.height > 1) keep_rays(cloud, scan);
  return {std::move(scan)};
}

void drop_not_finite(MeasuredScan& scan) {
  if (scan.points.empty()) return;
  // A difference with itself is 0 but for NaN and the infinities: one fast pass tells that nothing is to be done.
  const Eigen::Map<const Eigen::ArrayXd> numbers(scan.points.front().data(), static_cast<Eigen::Index>(3 * scan.points.size()));
  if ((numbers - numbers).sum() == 0.0) return;
  const auto end = std::remove_if(scan.points.begin(), scan.points.end(), [](const Vec<3>& p) { return !p.allFinite(); });
  scan.not_finite += scan.points.end() - end;
  scan.points.erase(end, scan.points.end());
}

std::vector<MeasuredScan> parse_as(std::string_view format, std::string_view bytes, std::string_view where) {
  const FileBytes file(bytes, where);
  if (format == "LAS") {
    require(bytes.starts_with("LASF"), "not a LAS file: it does not begin with LASF", where);
    return parse_las(file);
  }
  if (format == "E57") {
    require(bytes.starts_with("ASTM-E57"), "not an E57 file: it does not begin with ASTM-E57", where);
    return parse_e57(file);
  }
  if (format == "PTX") return parse_ptx(bytes, where);
  if (format == "OctoMap") return parse_octomap(file);
  if (format == "KITTI") return parse_kitti(file);
  return scan_of_cloud(format == "PLY" ? parse_ply_points(bytes, where) : format == "PCD" ? parse_pcd(bytes, where) : parse_xyz(bytes, where));
}

}  // namespace

std::optional<std::string_view> scan_format(std::string_view bytes, std::string_view where) {
  const std::optional<std::string_view> format = format_of_content(bytes);
  return format ? format : format_of_name(where);
}

std::vector<MeasuredScan> parse_scan_file(std::string_view bytes, std::string_view where) {
  require(!bytes.empty(), "the file is empty", where);
  std::vector<MeasuredScan> scans = parse_as(scan_format(bytes, where).value_or("text"), bytes, where);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    // A ray's index counts the points as the reader kept them: readers of rays leave no others.
    if (!scans[k].rays) drop_not_finite(scans[k]);
    scans[k].name = scans.size() == 1 ? std::string(where) : fmt::format("{}, scan {} of {}", where, k + 1, scans.size());
  }
  return scans;
}

std::vector<MeasuredScan> read_scan_file(const std::filesystem::path& path) { return parse_scan_file(read_buffer(path).view(), path.string()); }

}  // namespace vantage
