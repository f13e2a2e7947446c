// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arguments.h"
#include "commands.h"
#include "numbers.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/patch_file.h"
#include "vantage/io/vti.h"
#include "vantage/session/result.h"
#include "vantage/visibility/visibility.h"

using namespace vantage;

namespace {

constexpr const char* kPurpose =
    "Works out what is seen from a place past a known surface (surface.ply of a run or of reconstruct, or any PLY of convex faces), and\n"
    "writes the level set phi on a lattice: positive where seen, the distance to the surface [m]; a VTK image for ParaView.\n"
    "Without measured ranges a cone of 1 degree stands for a ray, as in the paper, so that cracks between patches do not leak.\n";

constexpr const char* kExamples =
    "  vantage visibility runs/town/surface.ply --from 20,-35,1.5 -o seen.vti\n"
    "  vantage visibility surface.ply --from 0,0,1 --voxel 0.1 --cone-deg 0 -o rays.vti";

struct Flags {
  std::string patches, from, path, voxel, grid, range, eta, cone, threads;
  bool json = false, quiet = false;
};

double number_or(const std::string& option, const std::string& text, double fallback, double low, double high) {
  if (text.empty()) return fallback;
  const std::vector<double> values = numbers(option, text);
  require(values.size() == 1 && values[0] >= low && values[0] <= high, fmt::format("{}: must be {} .. {}", text, low, high), option);
  return values[0];
}

/// A scan that met nothing: it knows where it was taken from, not what is there.
template <int Dim>
Scan<Dim> free_scan(const Vec<Dim>& from, double range) {
  Scan<Dim> scan;
  scan.origin = from;
  scan.pattern.max_range = range;
  scan.pattern.vertical_fov = radians(180.0);
  scan.ranges.assign(static_cast<std::size_t>(scan.pattern.columns() * scan.pattern.template rows<Dim>()), kNoReturn);
  return scan;
}

template <int Dim>
Json write_visibility(const std::vector<Patch<Dim>>& patches, const Flags& flags) {
  const std::vector<double> from = numbers("--from", flags.from);
  require(from.size() == Dim, fmt::format("{} numbers: the patches have {} dimensions", from.size(), Dim), "--from");
  const Vec<Dim> place = Eigen::Map<const Vec<Dim>>(from.data());
  const double range = number_or("--range", flags.range, 80.0, 1e-3, 1e5);
  Box<Dim> box;
  for (const Patch<Dim>& patch : patches) box.extend(patch.bounds());
  require(!box.empty(), "no patches", flags.patches);
  box.extend(place);
  const Vec<Dim> reach = Vec<Dim>::Constant(range);
  box = box.intersection({place - reach, place + reach});
  const double side = box.size().maxCoeff();
  const double voxel = flags.grid.empty() ? number_or("--voxel", flags.voxel, std::max(side / 128.0, 1e-3), 1e-4, 1e4)
                                          : side / static_cast<double>(whole_number("--grid", flags.grid, 2, 100000));
  const Vec<Dim> cells = (box.size() / voxel).array() + 3.0;
  require_memory(cells.prod(), 40.0, "the lattice");
  const Grid<Dim> window = window_over(box, voxel);
  float certified = 0.0F;
  for (const Patch<Dim>& patch : patches) certified = std::max({certified, patch.data_to_surface, patch.surface_to_data});
  const double eta = number_or("--eta", flags.eta, static_cast<double>(certified), 0.0, 10.0);
  VisibilityOptions options;
  options.range_image = false;
  options.cone_angle = radians(number_or("--cone-deg", flags.cone, 1.0, 0.0, 10.0));
  const Field<Dim> phi = visibility<Dim>(patches, free_scan(place, range), window, eta, options);
  const ImageArray arrays[] = {{"phi", std::span<const float>(phi.values)}};
  write_file(flags.path, image_as_vti<Dim>(window, arrays));
  const auto seen = std::count_if(phi.values.begin(), phi.values.end(), [](float v) { return v > 0.0F; });
  return {{"file", flags.path}, {"nodes", window.size()}, {"voxel_m", voxel},
          {"eta_m", eta},       {"seen_nodes", seen},     {"seen_fraction", static_cast<double>(seen) / static_cast<double>(window.size())}};
}

}  // namespace

int visibility_command(const Arguments& arguments) {
  CommandParser parser("visibility", "PATCHES --from x,y,z -o FILE [options]", kPurpose, kExamples);
  Flags flags;
  parser.app().add_option("PATCHES", flags.patches, "surface as PLY");
  parser.option("--from", flags.from, "x,y,z", "where one looks from [m] (2D: x,y)", "Method");
  parser.option("--voxel", flags.voxel, "METRES", "lattice spacing (1e-4 .. 1e4 m; default: 128 cells along the longest side)", "Method");
  parser.option("--grid", flags.grid, "CELLS", "cells along the longest side instead (2 .. 100000)", "Method");
  parser.option("--range", flags.range, "METRES", "how far one sees (1e-3 .. 1e5 m; default 80)", "Method");
  parser.option("--eta", flags.eta, "METRES", "patches are widened by this (0 .. 10 m; default: the worst certified error in the file)", "Method");
  parser.option("--cone-deg", flags.cone, "DEGREES", "full opening of the cone around a ray (0 .. 10; default 1; 0: plain rays)", "Method");
  parser.option("--threads", flags.threads, "N", "at most so many threads (default: all cores)", "Method");
  parser.option("-o,--output", flags.path, "FILE", ".vti", "Output");
  parser.flag("--json", flags.json, "print the figures as JSON", "Output");
  parser.flag("-q,--quiet", flags.quiet, "print nothing", "Output");
  if (!parser.parse(arguments)) return 0;
  require(!flags.patches.empty(), "PATCHES is missing");
  require(!flags.from.empty(), "--from is missing");
  require(flags.path.ends_with(".vti"), fmt::format("{}: must end in .vti", flags.path), "-o");
  const ThreadLimit limit(flags.threads.empty() ? 0 : static_cast<int>(whole_number("--threads", flags.threads, 1, 1024)));
  const Json result = std::visit([&](const auto& patches) { return write_visibility(patches, flags); }, read_patches(flags.patches));
  if (flags.json)
    fmt::print("{}", as_text(result));
  else if (!flags.quiet)
    fmt::print("{}: {:.1f} % of {} nodes are seen\n", flags.path, 100.0 * result["seen_fraction"].get<double>(),
               grouped(result["nodes"].get<std::int64_t>()));
  return 0;
}
