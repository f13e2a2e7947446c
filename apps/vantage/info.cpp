// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "arguments.h"
#include "commands.h"
#include "summary.h"
#include "vantage/base/error.h"
#include "vantage/session/inspect.h"

namespace {

constexpr const char* kPurpose =
    "Says what a file or a run folder holds: point clouds (PLY, PCD, E57, LAS, PTX, KITTI .bin, OctoMap .bt, XYZ, CSV), surfaces,\n"
    "exchanged maps, meshes, 2D maps, VTK images, NumPy arrays, GeoJSON, scan logs, scenarios and runs.\n";

constexpr const char* kExamples =
    "  vantage info runs/town\n"
    "  vantage info scan.pcd --json";

}  // namespace

int info_command(const Arguments& arguments) {
  CommandParser parser("info", "FILE | RUN", kPurpose, kExamples);
  std::string path;
  bool json = false;
  parser.app().add_option("FILE", path, "file or run folder");
  parser.flag("--json", json, "as JSON", "Output");
  if (!parser.parse(arguments)) return 0;
  vantage::require(!path.empty(), "FILE is missing");
  const vantage::Json result = vantage::inspect(path);
  fmt::print("{}", json ? vantage::as_text(result) : as_lines(result));
  return 0;
}
