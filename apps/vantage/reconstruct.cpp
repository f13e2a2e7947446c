// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "arguments.h"
#include "commands.h"
#include "summary.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/glb.h"
#include "vantage/io/patch_file.h"
#include "vantage/session/clouds.h"
#include "vantage/session/result.h"

namespace {

constexpr const char* kPurpose =
    "Fits surfaces to point clouds within a certified error: no measured point is farther than eta from the surface, and no place of the\n"
    "surface farther than eta from a point. Points that no surface explains stay as points. Reads PLY, PCD, XYZ, CSV, scan logs and run folders;\n"
    "several clouds count as one. Writes .ply (polygons, segments and points with the error of each) or .glb.\n";

constexpr const char* kExamples =
    "  vantage reconstruct scan0.pcd scan1.pcd --eta 0.05 -o surface.ply\n"
    "  vantage reconstruct runs/town --eta 0.2 -o coarse.glb\n"
    "  vantage reconstruct cloud.xyz --json        figures only";

template <int Dim>
vantage::Json reconstruct(const std::vector<vantage::Vec<Dim>>& points, const vantage::SurfaceOptions& options, const std::string& path) {
  vantage::Box<Dim> box;
  for (const vantage::Vec<Dim>& p : points)
    if (p.allFinite()) box.extend(p);
  vantage::require(!box.empty(), "the clouds have no finite point");
  // A little larger than the points, so that none lies on its very faces.
  vantage::HausdorffTree<Dim> tree(box.grown(0.001 * box.size().maxCoeff() + 1e-6), options);
  tree.insert(points);
  if (!path.empty()) {
    const std::vector<vantage::Patch<Dim>> patches = tree.patches();
    vantage::write_file(path, path.ends_with(".glb") ? vantage::surface_as_glb<Dim>(patches, {}) : vantage::patches_as_ply<Dim>(patches));
  }
  vantage::Json json = to_json(tree.statistics());
  json["dim"] = Dim;
  return json;
}

}  // namespace

int reconstruct_command(const Arguments& arguments) {
  CommandParser parser("reconstruct", "CLOUD… [-o FILE] [options]", kPurpose, kExamples);
  std::vector<std::string> clouds, sets;
  std::string path, eta, threads;
  bool json = false, quiet = false, paper = false;
  vantage::SurfaceOptions options;
  parser.app().add_option("CLOUD", clouds, "point clouds, scan logs or run folders");
  parser.option("-o,--output", path, "FILE", ".ply or .glb", "Output");
  parser.flag("--json", json, "print the figures as JSON", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing", "Output");
  for (const vantage::Option& option : list_options(options))
    if (option.name == "eta")
      parser.option("--eta", eta, "METRES", fmt::format("{} ({}; default {})", option.doc, option.allowed(), option.text()), "Method");
  parser.flag("--paper", paper, "the paper's own behaviour: small cells dropped, best fit kept at the depth limit (surface.paper)", "Method");
  parser.app()
      .add_option("--set", sets, "any option of the stage surface; vantage config dump lists them")
      ->type_name("surface.OPTION=VALUE")
      ->group("Method");
  parser.option("--threads", threads, "N", "at most so many threads (default: all cores)", "Method");
  if (!parser.parse(arguments)) return 0;
  vantage::require(!clouds.empty(), "CLOUD is missing");
  vantage::require(path.empty() || path.ends_with(".ply") || path.ends_with(".glb"), fmt::format("{}: must end in .ply or .glb", path), "-o");
  if (!eta.empty()) sets.push_back("surface.eta=" + eta);
  if (paper) sets.emplace_back("surface.paper=true");
  set_options(list_options(options), "surface", sets);
  const vantage::ThreadLimit limit(threads.empty() ? 0 : static_cast<int>(whole_number("--threads", threads, 1, 1024)));
  const std::vector<std::filesystem::path> paths(clouds.begin(), clouds.end());
  const vantage::AnyPoints points = vantage::read_clouds(paths);
  const vantage::Json surface = std::visit([&](const auto& p) { return reconstruct(p, options, path); }, points);
  if (json)
    fmt::print("{}", vantage::as_text(surface));
  else if (!quiet)
    fmt::print("{}{}\n", path.empty() ? "" : path + ": ", surface_sentence(surface, surface["dim"].get<int>()));
  return 0;
}
