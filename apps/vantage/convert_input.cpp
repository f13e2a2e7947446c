// SPDX-License-Identifier: Apache-2.0
#include "convert_input.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>

#include "vantage/base/error.h"
#include "vantage/io/mesh_file.h"
#include "vantage/io/ply_file.h"
#include "vantage/io/point_cloud_file.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scan_log.h"

using namespace vantage;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kHead = 1 << 16;  // Bytes that tell what a file is; a header of PLY ends within them.

std::string first_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kHead, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

ConvertKind kind_of_ply(const std::string& head, const fs::path& path) {
  std::size_t offset = 0;
  const Ply ply = parse_ply_header(head, path.string(), offset);
  const auto count = [&](std::string_view name) { return ply.find(name) == nullptr ? 0 : ply.find(name)->count; };
  return ply.find("point") != nullptr || count("face") > 0 || count("edge") > 0 ? ConvertKind::surface : ConvertKind::scans;
}

fs::path log_of(const fs::path& in) { return is_run_folder(in) ? in / run_file::kScanLog : in; }

bool is_log(const fs::path& in) { return is_run_folder(in) || first_bytes(in).starts_with("VANTSCAN"); }

template <int Dim>
LoadedScans load_log(const fs::path& path) {
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(path);
  LoadedScans loaded;
  std::int64_t no_return = 0;
  for (int i = 0; i < log.size(); ++i) {
    const Scan<Dim> scan = log.read(i);
    no_return += std::count_if(scan.ranges.begin(), scan.ranges.end(), [](float range) { return range == kNoReturn; });
    loaded.scans.push_back(as_measured(scan));
    loaded.scans.back().name = fmt::format("scan {}", i);
  }
  if (no_return > 0) loaded.left_out.push_back(fmt::format("{} rays without return", no_return));
  return loaded;
}

/// The points of a table of the run folder; none if it is not there.
std::vector<Vec<3>> places_of(const fs::path& table) { return fs::exists(table) ? read_points(table).points : std::vector<Vec<3>>(); }

}  // namespace

ConvertKind convert_kind(const fs::path& in) {
  if (fs::is_directory(in)) {
    require(is_run_folder(in), "a folder without scans.log and scenario.toml is no run", in.string());
    return ConvertKind::scans;
  }
  if (!fs::exists(in)) throw Error(ErrorCode::io, "no such file", in.string());
  const std::string head = first_bytes(in);
  require(!head.empty(), "the file is empty", in.string());
  if (head.starts_with("VANTSCAN")) return ConvertKind::scans;
  require(!head.starts_with("VANTMAP"), "an exchanged map: vantage merge writes its surfaces", in.string());
  if (head.starts_with("ply")) return kind_of_ply(head, in);
  if (in.extension() == ".vti") return ConvertKind::field;
  if (scan_format(head, in.string())) return ConvertKind::scans;
  require(!is_mesh_file(in), "a mesh: vantage scene FILE -o OUT writes it as .ply, .obj or .stl", in.string());
  throw Error(ErrorCode::bad_input, "neither scans (docs/12-files.md) nor a surface (.ply), a field (.vti) or a run folder", in.string());
}

template <int Dim>
MeasuredScan as_measured(const Scan<Dim>& scan) {
  MeasuredScan measured;
  measured.format = "scan";
  measured.dim = Dim;
  for (const Vec<Dim>& p : hit_points(scan)) measured.points.emplace_back(Vec<3>::Zero()).template head<Dim>() = p;
  measured.position = Vec<3>::Zero();
  measured.position->template head<Dim>() = scan.origin;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<Dim, Dim>() = scan.world_from_sensor;
  measured.orientation = Eigen::Quaterniond(rotation);
  return measured;
}

LoadedScans load_scans(const fs::path& in) {
  if (!is_log(in)) return {read_scan_file(in), {}};
  const fs::path log = log_of(in);
  return scan_log_dim(log) == 2 ? load_log<2>(log) : load_log<3>(log);
}

std::vector<MapFeature> map_features(const fs::path& in, const std::vector<MeasuredScan>& scans) {
  std::vector<MapFeature> features;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (!scans[k].position) continue;
    features.push_back({{*scans[k].position},
                        {{"kind", "station"},
                         {"id", static_cast<std::int64_t>(k)},
                         {"name", fs::path(scans[k].name).filename().string()},
                         {"points", static_cast<std::int64_t>(scans[k].points.size())}}});
  }
  if (!is_run_folder(in)) return features;
  const std::vector<Vec<3>> path = places_of(in / run_file::kPath), next = places_of(in / run_file::kNextTable);
  if (path.size() > 1) features.push_back({path, {{"kind", "path"}}});
  for (std::size_t k = 0; k < next.size(); ++k) features.push_back({{next[k]}, {{"kind", "next"}, {"rank", static_cast<std::int64_t>(k + 1)}}});
  return features;
}

template MeasuredScan as_measured<2>(const Scan<2>&);
template MeasuredScan as_measured<3>(const Scan<3>&);
