// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/json_text.h"
#include "vantage/io/npy.h"
#include "vantage/io/patch_file.h"
#include "vantage/io/ply_file.h"
#include "vantage/io/scan_file.h"
#include "vantage/io/vti.h"
#include "vantage/session/exchanged.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scan_log.h"
#include "vantage/session/scenario_file.h"
#include "vantage/world/scene.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

template <int Dim>
Json bounds_json(const Box<Dim>& box) {
  if (box.empty()) return nullptr;
  return Json::array({to_json<Dim>(box.low), to_json<Dim>(box.high)});
}

/// What a scan holds beside its format.
Json scan_json(const MeasuredScan& scan) {
  Box<3> box;
  for (const Vec<3>& p : scan.points) box.extend(p);
  Json json = {{"points", scan.points.size()}, {"not_finite", scan.not_finite}, {"bounds", bounds_json(box)}};
  if (scan.position) json["position"] = to_json<3>(*scan.position);
  if (scan.epsg) json["crs"] = fmt::format("EPSG:{}", *scan.epsg);
  if (scan.rays) {
    const auto count = [&](std::int32_t what) { return std::count(scan.rays->point.begin(), scan.rays->point.end(), what); };
    json["rays"] = {
        {"columns", scan.rays->columns}, {"rows", scan.rays->rows}, {"no_return", count(RayTable::kNoReturn)}, {"no_data", count(RayTable::kNoData)}};
  }
  return json;
}

Json inspect_points(const fs::path& path) {
  const std::vector<MeasuredScan> scans = read_scan_file(path);
  Json json = {{"kind", "point cloud"}};
  if (scans.size() == 1) {
    json.update({{"format", scans[0].format}, {"dim", scans[0].dim}});
    json.update(scan_json(scans[0]));
    return json;
  }
  Box<3> box;
  std::size_t points = 0;
  std::int64_t not_finite = 0;
  Json each = Json::array();
  for (const MeasuredScan& scan : scans) {
    each.push_back(scan_json(scan));
    for (const Vec<3>& p : scan.points) box.extend(p);
    points += scan.points.size();
    not_finite += scan.not_finite;
  }
  const std::string format = scans.empty() ? "E57" : scans[0].format;
  json.update({{"format", format}, {"dim", 3}, {"points", points}, {"not_finite", not_finite}, {"bounds", bounds_json(box)}, {"scans", each}});
  return json;
}

template <int Dim>
Json inspect_patches(const std::vector<Patch<Dim>>& patches) {
  std::int64_t by_rank[3] = {0, 0, 0};
  double area = 0.0, certified = 0.0;
  Box<Dim> box;
  for (const Patch<Dim>& patch : patches) {
    ++by_rank[patch.rank()];
    area += measure(patch);
    certified = std::max({certified, static_cast<double>(patch.data_to_surface), static_cast<double>(patch.surface_to_data)});
    box.extend(patch.bounds());
  }
  return {{"kind", "surface"},    {"dim", Dim},      {"polygons", by_rank[2]},   {"segments", by_rank[1]},
          {"points", by_rank[0]}, {"measure", area}, {"certified_m", certified}, {"bounds", bounds_json(box)}};
}

template <int Dim>
Json inspect_log(const fs::path& path) {
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(path);
  std::int64_t rays = 0, hits = 0, no_data = 0;
  Box<Dim> stations;
  for (int i = 0; i < log.size(); ++i) {
    const Scan<Dim> scan = log.read(i);
    rays += static_cast<std::int64_t>(scan.ranges.size());
    hits += std::count_if(scan.ranges.begin(), scan.ranges.end(), [](float r) { return std::isfinite(r); });
    no_data += std::count_if(scan.ranges.begin(), scan.ranges.end(), [](float r) { return std::isnan(r); });
    stations.extend(scan.origin);
  }
  return {{"kind", "scan log"},  {"dim", Dim},
          {"scans", log.size()}, {"rays", rays},
          {"hits", hits},        {"no_return", rays - hits - no_data},
          {"no_data", no_data},  {"stations", bounds_json(stations)}};
}

Json inspect_image(const fs::path& path) {
  const ImageInfo info = parse_vti_header(read_file(path), path.string());
  Json arrays = Json::array();
  for (const ImageInfo::Array& array : info.arrays) arrays.push_back(array.name + " " + array.type);
  return {{"kind", "lattice"}, {"nodes", info.nodes}, {"origin_m", info.origin}, {"spacing_m", info.spacing}, {"arrays", arrays}};
}

/// A member, or nothing where there is none.
Json member(const Json& json, const char* name) { return json.is_object() && json.contains(name) ? json[name] : Json(); }

Json inspect_features(const fs::path& path) {
  const Json map = parse_json<Json>(read_file(path), path.string()), features = member(map, "features");
  require(features.is_array(), "not GeoJSON: no features", path.string());
  Json count = Json::object();
  for (const Json& feature : features) {
    const Json kind = member(member(feature, "properties"), "kind");
    const std::string name = kind.is_string() ? kind.get<std::string>() : "other";
    count[name] = count.value(name, 0) + 1;
  }
  const Json crs = member(member(member(map, "crs"), "properties"), "name");
  return {{"kind", "map features"}, {"crs", crs.is_string() ? crs : Json("WGS 84")}, {"features", count}};
}

Json inspect_scene(const fs::path& path) {
  return std::visit(
      []<int Dim>(const Scene<Dim>& scene) -> Json {
        return {{"kind", "scene"},
                {"name", scene.name},
                {"dim", Dim},
                {"vertices", scene.mesh.vertices.size()},
                {"facets", scene.mesh.facets.size()},
                {"bounds", bounds_json(scene.mesh.bounds())},
                {"start", to_json<Dim>(scene.start)},
                {"voxel_m", scene.voxel},
                {"eta_m", scene.eta}};
      },
      make_scene(path.string()));
}

Json inspect_scenario(const fs::path& path) {
  Json settings = Json::object();
  for (const Setting& setting : read_scenario(path)) settings[setting.name] = setting.value;
  return {{"kind", "scenario"}, {"settings", settings}};
}

Json inspect_run(const fs::path& folder) {
  require(is_run_folder(folder), "a folder without scans.log and scenario.toml is no run", folder.string());
  Json json = {{"kind", "run"}, {"folder", folder.string()}};
  const fs::path result = folder / run_file::kResult;
  if (!fs::exists(result)) {
    json["state"] = "stopped before its outputs were saved; --resume goes on";
    return json;
  }
  const Json saved = parse_json<Json>(read_file(result), result.string());
  require(member(saved, "verdict").is_object() && member(saved, "surface").is_object(), "not a result", result.string());
  for (const char* key : {"scene", "dim", "scans", "path_m", "verdict", "surface"}) json[key] = saved.value(key, Json());
  json["verdict"].erase("unseen");
  json["report"] = (folder / run_file::kReport).string();
  return json;
}

Json inspect_ply(const fs::path& path) {
  const std::string bytes = read_file(path);
  std::size_t offset = 0;
  const Ply ply = parse_ply_header(bytes, path.string(), offset);
  const auto count = [&](std::string_view name) { return ply.find(name) == nullptr ? 0 : ply.find(name)->count; };
  const bool ours = ply.find("point") != nullptr;
  if (ours) return std::visit([](const auto& patches) { return inspect_patches(patches); }, parse_patches(bytes, path.string()));
  return count("face") > 0 ? inspect_scene(path) : inspect_points(path);
}

std::string first_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(4096, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

}  // namespace

Json inspect(const fs::path& path) {
  if (fs::is_directory(path)) return inspect_run(path);
  if (!fs::exists(path)) throw Error(ErrorCode::io, "no such file", path.string());
  const std::string head = first_bytes(path);
  require(!head.empty(), "the file is empty", path.string());
  if (head.starts_with("VANTSCAN")) return scan_log_dim(path) == 2 ? inspect_log<2>(path) : inspect_log<3>(path);
  if (head.starts_with(kMapMagic.substr(0, 7))) return describe_map(read_map(path), path.string());
  if (head.starts_with("ply")) return inspect_ply(path);
  const std::string extension = path.extension().string();
  if (extension == ".vti") return inspect_image(path);
  if (extension == ".npy") return {{"kind", "array"}, {"numpy", describe_npy(read_file(path), path.string())}};
  if (extension == ".geojson") return inspect_features(path);
  if (extension == ".toml") return inspect_scenario(path);
  if (scan_format(head, path.string())) return inspect_points(path);
  return inspect_scene(path);
}

}  // namespace vantage
