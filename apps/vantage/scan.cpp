// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "commands.h"
#include "convert_input.h"
#include "numbers.h"
#include "scenario_arguments.h"
#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/point_cloud_file.h"
#include "vantage/io/scan_writer.h"
#include "vantage/session/result.h"
#include "vantage/session/scan_log.h"

namespace {

constexpr const char* kPurpose =
    "Takes one simulated scan of a scene and writes its points (.ply, .pcd with the place as VIEWPOINT, .las, .xyz, .csv), or the whole\n"
    "scan with the rays that met nothing (.log, as in a run folder).\n";

constexpr const char* kExamples =
    "  vantage scan town --at 20,-35,1.5 -o scan.ply\n"
    "  vantage scan pipes --at 0,0,1 --step-deg 2 --noise 0.01 -o scan.xyz";

template <int Dim>
std::string file_bytes(const vantage::Scan<Dim>& scan, const std::string& path) {
  if (path.ends_with(".log")) return vantage::scans_as_log<Dim>(std::span(&scan, 1));
  const std::string_view format = *vantage::written_scan_format(path);
  if (format == "PLY") return vantage::points_as_ply<Dim>(vantage::hit_points(scan));
  const vantage::MeasuredScan measured = as_measured(scan);
  return vantage::scans_as(format, std::span(&measured, 1)).bytes;
}

template <int Dim>
vantage::Json take_scan(const vantage::World& world, const vantage::Scene<Dim>& scene, const std::vector<double>& at, const std::string& path) {
  vantage::require(at.size() == Dim, fmt::format("{} numbers: {} has {} dimensions", at.size(), scene.name, Dim), "--at");
  const vantage::Vec<Dim> place = Eigen::Map<const vantage::Vec<Dim>>(at.data());
  vantage::SimulatedLidar<Dim> lidar(scene.mesh, world.scenario.sensor);
  const vantage::Scan<Dim> scan = lidar.scan(place, 0);
  vantage::write_file(path, file_bytes<Dim>(scan, path));
  const std::size_t points = vantage::hit_points(scan).size();
  return {{"file", path}, {"vantage", at}, {"rays", scan.ranges.size()}, {"points", points}};
}

}  // namespace

int scan_command(const Arguments& arguments) {
  CommandParser parser("scan", "SCENE --at x,y,z -o FILE [options]", kPurpose, kExamples);
  std::string at, path;
  bool json = false, quiet = false;
  parser.option("--at", at, "x,y,z", "where the scanner stands [m] (2D: x,y; default: the scene's start)", "Scan");
  parser.option("-o,--output", path, "FILE", ".ply, .pcd, .las, .xyz, .csv or .log", "Scan");
  parser.flag("--json", json, "print what was written as JSON", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing", "Output");
  ScenarioArguments scenario(parser);
  if (!parser.parse(arguments)) return 0;
  vantage::require(!scenario.scene().empty(), "SCENE is missing: vantage scene --list names some");
  vantage::require(path.ends_with(".log") || vantage::written_scan_format(path).has_value(),
                   fmt::format("{}: must end in .ply, .pcd, .las, .xyz, .csv or .log", path), "-o");
  const vantage::World world = make_world(scenario.scene(), scenario.settings());
  const std::vector<double> place = at.empty() ? world.scenario.start : numbers("--at", at);
  const vantage::Json result = std::visit([&](const auto& scene) { return take_scan(world, scene, place, path); }, world.scene);
  if (json)
    fmt::print("{}", vantage::as_text(result));
  else if (!quiet)
    fmt::print("{}: {} points of {} rays\n", path, grouped(result["points"].get<std::int64_t>()), grouped(result["rays"].get<std::int64_t>()));
  return 0;
}
