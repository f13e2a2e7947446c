// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "arguments.h"
#include "commands.h"
#include "numbers.h"
#include "scenario_arguments.h"
#include "vantage/base/error.h"
#include "vantage/io/mesh_file.h"
#include "vantage/session/result.h"

using vantage::Json;

namespace {

constexpr const char* kPurpose = "Writes a scene as a mesh (.ply, .obj, .stl; a plane scene as line segments), or lists the built-in scenes.\n";

constexpr const char* kExamples =
    "  vantage scene --list\n"
    "  vantage scene town:seed=3 -o town.ply";

Json list_json() {
  Json all = Json::array();
  for (const vantage::SceneInfo& scene : vantage::scene_list()) {
    Json parameters = Json::array();
    for (const auto& p : scene.parameters)
      parameters.push_back({{"name", p.name}, {"default", p.value}, {"low", p.low}, {"high", p.high}, {"doc", p.doc}});
    all.push_back({{"name", scene.name}, {"dim", scene.dim}, {"description", scene.description}, {"parameters", parameters}});
  }
  return all;
}

std::string list_text() {
  std::string out;
  for (const int dim : {3, 2}) {
    out += fmt::format("{}Built-in scenes in {}D\n", out.empty() ? "" : "\n", dim);
    for (const vantage::SceneInfo& scene : vantage::scene_list()) {
      if (scene.dim != dim) continue;
      out += fmt::format("  {:<10} {}\n", scene.name, scene.description);
      for (const auto& p : scene.parameters) out += fmt::format("  {:<10}   {} = {}  {} ({} .. {})\n", "", p.name, p.value, p.doc, p.low, p.high);
    }
  }
  return out + "\nParameters follow a colon: vantage explore pipes:cylinders=12,seed=3\n";
}

Json write_scene(const vantage::AnyScene& any, const std::string& path) {
  return std::visit(
      [&]<int Dim>(const vantage::Scene<Dim>& scene) -> Json {
        vantage::write_mesh(path, scene.mesh);
        const vantage::Box<Dim> box = scene.mesh.bounds();
        return {{"file", path},
                {"scene", scene.name},
                {"dim", Dim},
                {"vertices", scene.mesh.vertices.size()},
                {"facets", scene.mesh.facets.size()},
                {"bounds", {vantage::to_json<Dim>(box.low), vantage::to_json<Dim>(box.high)}}};
      },
      any);
}

}  // namespace

int scene_command(const Arguments& arguments) {
  CommandParser parser("scene", "NAME -o FILE | --list", kPurpose, kExamples);
  std::string path;
  bool list = false, json = false, quiet = false;
  parser.flag("--list", list, "the built-in scenes with their parameters", "Output");
  parser.option("-o,--output", path, "FILE", ".ply, .obj or .stl", "Output");
  parser.flag("--json", json, "the same as JSON", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing", "Output");
  std::string name, up, unit, ground, detail;
  parser.app().add_option("NAME", name, kSceneHelp);
  parser.option("--up", up, "AXIS", "up axis of a mesh file (file | y | z)", "Scene");
  parser.option("--unit", unit, "METRES", "metres per unit of a mesh file", "Scene");
  parser.option("--ground", ground, "Z", "height of level ground that is added to mesh files which have none [m]", "Scene");
  parser.option("--detail", detail, "LEVEL", "highest level of detail of a city model (default: the highest of each object)", "Scene");
  if (!parser.parse(arguments)) return 0;
  if (list) {
    fmt::print("{}", json ? vantage::as_text(list_json()) : list_text());
    return 0;
  }
  vantage::require(!name.empty(), "NAME is missing: vantage scene --list names some");
  vantage::require(!path.empty(), "-o FILE is missing");
  std::vector<vantage::Setting> settings;
  if (!up.empty()) settings.push_back({"scene.up", up, "--up"});
  if (!unit.empty()) settings.push_back({"scene.unit", unit, "--unit"});
  if (!ground.empty()) settings.push_back({"scene.ground", ground, "--ground"});
  if (!detail.empty()) settings.push_back({"scene.detail", detail, "--detail"});
  const Json result = write_scene(vantage::make_world(name, settings).scene, path);
  if (json)
    fmt::print("{}", vantage::as_text(result));
  else if (!quiet)
    fmt::print("{}: {} {}\n", path, grouped(result["facets"].get<std::int64_t>()), result["dim"] == 2 ? "segments" : "triangles");
  return 0;
}
