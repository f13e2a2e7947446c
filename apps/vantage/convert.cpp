// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "arguments.h"
#include "commands.h"
#include "convert_input.h"
#include "numbers.h"
#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/glb.h"
#include "vantage/io/npy.h"
#include "vantage/io/obj.h"
#include "vantage/io/octomap.h"
#include "vantage/io/patch_file.h"
#include "vantage/io/scan_writer.h"
#include "vantage/io/vdb.h"
#include "vantage/session/result.h"
#include "vantage/session/run_folder.h"

using namespace vantage;
namespace fs = std::filesystem;

namespace {

constexpr const char* kPurpose =
    "Writes a file in another format, told by the ending of OUT. What OUT cannot hold is named on stderr. Numbers stay as they are: feet stay\n"
    "feet, and large coordinates keep their digits.\n\n"
    "  scans    any file that info reads, a scan log or a run folder   to .ply .pcd .las .xyz .csv .geojson (stations and path)\n"
    "  surface  the .ply of reconstruct, or another of convex faces    to .ply .obj .glb\n"
    "  field    a .vti of a run or of visibility                       to .vti .npy .bt (OctoMap: free, occupied, unknown) .vdb\n\n"
    "Of a run folder, .obj and .glb take its surface.ply, .vti, .npy, .bt and .vdb its belief.vti. LAZ: vantage-convert of the Python package.\n";

constexpr const char* kExamples =
    "  vantage convert hall.e57 hall.las --resolution 0.001 --crs EPSG:25832\n"
    "  vantage convert hall.e57 third.pcd --scan 2               with its pose as VIEWPOINT\n"
    "  vantage convert runs/town belief.bt                       for OctoMap's tools and planners\n"
    "  vantage convert runs/town psi.npy --array psi             a = numpy.load(\"psi.npy\"); a[i, j, k]\n"
    "  vantage convert hall stations.geojson --crs EPSG:25832    for QGIS\n"
    "Exit: 0 done, 2 bad input, 3 files, 4 memory.";

struct Flags {
  std::string in, out, number, resolution, las, crs, scan, array;
  bool ascii = false, force = false, json = false, quiet = false;
};

/// What an ending takes.
struct Target {
  std::string_view ending;
  std::vector<ConvertKind> kinds;
};

const std::vector<Target>& targets() {
  using enum ConvertKind;
  static const std::vector<Target> all = {{".ply", {scans, surface}}, {".pcd", {scans}},   {".las", {scans}}, {".xyz", {scans}},
                                          {".txt", {scans}},          {".asc", {scans}},   {".csv", {scans}}, {".geojson", {scans}},
                                          {".obj", {surface}},        {".glb", {surface}}, {".vti", {field}}, {".npy", {field}},
                                          {".bt", {field}},           {".vdb", {field}}};
  return all;
}

std::string endings(ConvertKind kind) {
  std::string out;
  for (const Target& target : targets())
    if (std::find(target.kinds.begin(), target.kinds.end(), kind) != target.kinds.end()) out += fmt::format(" {}", target.ending);
  return out.substr(1);
}

std::string_view name_of(ConvertKind kind) { return kind == ConvertKind::scans ? "scans" : kind == ConvertKind::surface ? "a surface" : "a field"; }

const Target& target_of(const std::string& out) {
  std::string ending = fs::path(out).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  require(ending != ".vdb" || has_openvdb(), "this build has no OpenVDB (libopenvdb-dev)", out);
  require(ending != ".laz", "vantage-convert IN.las OUT.laz of the Python package writes LAZ; .las is written here", out);
  for (const Target& target : targets())
    if (target.ending == ending) return target;
  throw Error(ErrorCode::bad_input,
              fmt::format("{}: must end in {}, {} or {}", ending.empty() ? "no ending" : ending, endings(ConvertKind::scans), ".obj .glb",
                          endings(ConvertKind::field)),
              out);
}

/// Options that only some endings know.
void check_flags(const Flags& flags, std::string_view ending) {
  const struct {
    const char* name;
    bool given;
    std::string endings;
  } kTable[] = {{"--ascii", flags.ascii, ".ply .pcd"},
                {"--number", !flags.number.empty(), ".ply .pcd"},
                {"--resolution", !flags.resolution.empty(), ".las"},
                {"--las", !flags.las.empty(), ".las"},
                {"--crs", !flags.crs.empty(), ".las .geojson"},
                {"--scan", !flags.scan.empty(), endings(ConvertKind::scans)},
                {"--array", !flags.array.empty(), ".vti .npy .bt .vdb"}};
  for (const auto& row : kTable) {
    const bool known = fmt::format(" {} ", row.endings).find(fmt::format(" {} ", ending)) != std::string::npos;
    require(!row.given || known, fmt::format("only for {}, not for {}", row.endings, ending), row.name);
  }
}

/// What is written, and what to say of it.
struct Written {
  std::string bytes, sentence;
  Json figures;
  std::vector<std::string> left_out;
};

ScanWriteOptions write_options(const Flags& flags, const std::vector<MeasuredScan>& scans) {
  ScanWriteOptions options;
  options.ascii = flags.ascii;
  require(flags.number.empty() || flags.number == "float" || flags.number == "double", flags.number + ": must be float or double", "--number");
  if (!flags.number.empty()) options.number = flags.number == "float" ? ScanWriteOptions::Number::float32 : ScanWriteOptions::Number::float64;
  if (!flags.resolution.empty()) {
    const std::vector<double> value = numbers("--resolution", flags.resolution);
    require(value.size() == 1 && value[0] >= 1e-9 && value[0] <= 1e3, flags.resolution + ": must be 1e-9 .. 1000", "--resolution");
    options.resolution = value[0];
  }
  require(flags.las.empty() || flags.las == "1.2" || flags.las == "1.4", flags.las + ": must be 1.2 or 1.4", "--las");
  if (!flags.las.empty()) options.las_minor = flags.las == "1.2" ? 2 : 4;
  if (!flags.crs.empty())
    options.epsg = parse_epsg(flags.crs, "--crs");
  else if (!scans.empty())
    options.epsg = scans.front().epsg;
  return options;
}

Written stations_written(const Flags& flags, const std::vector<MeasuredScan>& scans) {
  const std::optional<int> epsg = write_options(flags, scans).epsg;
  require(epsg.has_value(), "--crs EPSG:CODE is missing: a map must say what its coordinates are", flags.out);
  const std::vector<MapFeature> features = map_features(flags.in, scans);
  require(!features.empty(), "no scan of it says where it was taken", flags.in);
  return {features_as_geojson(features, *epsg),
          fmt::format("{} places and lines in EPSG:{}", features.size(), *epsg),
          {{"features", features.size()}, {"epsg", *epsg}},
          {}};
}

Written scans_written(const Flags& flags, std::string_view ending) {
  LoadedScans loaded = load_scans(flags.in);
  std::vector<MeasuredScan>& scans = loaded.scans;
  if (!flags.scan.empty()) {
    require(!scans.empty(), "no scans in it", flags.in);
    const auto k = whole_number("--scan", flags.scan, 0, static_cast<std::int64_t>(scans.size()) - 1);
    scans = std::vector<MeasuredScan>(1, std::move(scans[static_cast<std::size_t>(k)]));
  }
  if (ending == ".geojson") return stations_written(flags, scans);
  const ScanWriteOptions options = write_options(flags, scans);
  WrittenScans written = scans_as(*written_scan_format(ending), scans, options);
  std::size_t points = 0;
  for (const MeasuredScan& scan : scans) points += scan.points.size();
  const std::string of = scans.size() == 1 ? "" : fmt::format(" of {} scans", scans.size());
  std::vector<std::string> left_out = std::move(written.left_out);
  left_out.insert(left_out.end(), loaded.left_out.begin(), loaded.left_out.end());
  if (options.epsg && ending != ".las") left_out.push_back(fmt::format("the coordinate system, EPSG:{}", *options.epsg));
  Json figures = {{"scans", scans.size()}, {"points", points}, {"numbers", written.precision}};
  if (options.epsg && ending == ".las") figures["epsg"] = *options.epsg;
  return {std::move(written.bytes), fmt::format("{} points{}, {}", grouped(static_cast<std::int64_t>(points)), of, written.precision), figures,
          left_out};
}

Written surface_written(const fs::path& in, std::string_view ending) {
  return std::visit(
      [&]<int Dim>(const std::vector<Patch<Dim>>& patches) -> Written {
        Written written{
            {}, fmt::format("{} patches", grouped(static_cast<std::int64_t>(patches.size()))), {{"patches", patches.size()}, {"dim", Dim}}, {}};
        written.bytes = ending == ".obj"   ? patches_as_obj<Dim>(patches)
                        : ending == ".glb" ? surface_as_glb<Dim>(patches, {})
                                           : patches_as_ply<Dim>(patches);
        const bool certified =
            std::any_of(patches.begin(), patches.end(), [](const Patch<Dim>& p) { return p.data_to_surface > 0.0F || p.surface_to_data > 0.0F; });
        if (certified && ending != ".ply") written.left_out.emplace_back("the certified errors");
        if (ending == ".glb") written.left_out.emplace_back("digits beyond a float about the middle");
        return written;
      },
      read_patches(in));
}

const LatticeArray& chosen_array(const LatticeImage& image, const std::string& wanted, const std::string& in) {
  std::string names;
  for (const LatticeArray& array : image.arrays) {
    if (array.name == wanted) return array;
    names += (names.empty() ? "" : ", ") + array.name;
  }
  require(!image.arrays.empty(), "no arrays in it", in);
  require(!wanted.empty() || image.arrays.size() == 1, fmt::format("is missing: one of {}", names), "--array");
  require(wanted.empty(), fmt::format("no array {} in it, only {}", wanted, names), in);
  return image.arrays.front();
}

std::string octomap_of(const LatticeImage& image, const LatticeArray& array, const std::string& in) {
  const auto* values = std::get_if<std::vector<std::uint8_t>>(&array.values);
  require(values != nullptr && std::all_of(values->begin(), values->end(), [](std::uint8_t v) { return v <= 2; }),
          fmt::format("array {}: must be states, 0 unseen, 1 seen, 2 obstacle", array.name), in);
  Field<3, NodeState> states;
  states.window = image.window;
  for (const std::uint8_t value : *values) states.values.push_back(static_cast<NodeState>(value));
  return states_as_octomap<3>(states);
}

std::string image_of(const LatticeImage& image, std::span<const LatticeArray* const> arrays) {
  std::vector<ImageArray> views;
  for (const LatticeArray* array : arrays)
    std::visit([&]<class Value>(const std::vector<Value>& values) { views.push_back({array->name, std::span<const Value>(values)}); }, array->values);
  return image_as_vti<3>(image.window, views);
}

Written field_written(const Flags& flags, const fs::path& in, std::string_view ending) {
  const LatticeImage image = parse_vti(read_buffer(in).view(), in.string());
  const Grid<3>& window = image.window;
  const std::int64_t nodes[] = {window.extent[0], window.extent[1], window.extent[2]};
  std::vector<const LatticeArray*> arrays;
  if (ending == ".vti" && flags.array.empty())
    for (const LatticeArray& array : image.arrays) arrays.push_back(&array);
  else
    arrays.push_back(&chosen_array(image, ending == ".bt" && flags.array.empty() ? "state" : flags.array, in.string()));
  Written written{{}, fmt::format("{} nodes", fmt::join(nodes, " x ")), {{"nodes", nodes}}, {}};
  for (const LatticeArray* array : arrays) written.figures["arrays"].push_back(array->name);
  for (const LatticeArray& array : image.arrays)
    if (std::find(arrays.begin(), arrays.end(), &array) == arrays.end()) written.left_out.push_back("array " + array.name);
  const Vec<3> origin = window.position(Index<3>(Index<3>::Zero()));
  if (ending == ".npy")
    written.left_out.push_back(
        fmt::format("the place of node 0 0 0 ({} {} {}) and the spacing ({})", origin[0], origin[1], origin[2], window.spacing));
  written.bytes = ending == ".npy"   ? array_as_npy(*arrays[0], nodes)
                  : ending == ".bt"  ? octomap_of(image, *arrays[0], in.string())
                  : ending == ".vdb" ? array_as_vdb(*arrays[0], window)
                                     : image_of(image, arrays);
  return written;
}

Written converted(const Flags& flags) {
  const Target& target = target_of(flags.out);
  check_flags(flags, target.ending);
  ConvertKind kind = convert_kind(flags.in);
  fs::path in = flags.in;
  const bool wanted = std::find(target.kinds.begin(), target.kinds.end(), kind) != target.kinds.end();
  if (fs::is_directory(in) && !wanted) {
    kind = target.kinds.front();
    in /= kind == ConvertKind::surface ? run_file::kSurface : run_file::kBelief;
  } else {
    require(wanted, fmt::format("holds {}, written as {}, not as {}", name_of(kind), endings(kind), target.ending), flags.in);
  }
  if (kind == ConvertKind::scans) return scans_written(flags, target.ending);
  require(!flags.ascii && flags.number.empty(), "only for points, not for a surface", flags.ascii ? "--ascii" : "--number");
  require(flags.scan.empty(), "only for scans, not for a surface", "--scan");
  return kind == ConvertKind::surface ? surface_written(in, target.ending) : field_written(flags, in, target.ending);
}

}  // namespace

int convert_command(const Arguments& arguments) {
  CommandParser parser("convert", "IN OUT [options]", kPurpose, kExamples);
  Flags flags;
  parser.app().add_option("IN", flags.in, "file or run folder");
  parser.app().add_option("OUT", flags.out, "file to write");
  parser.flag("--ascii", flags.ascii, "numbers as text (points in .ply and .pcd)", "Points");
  parser.option("--number", flags.number, "TYPE",
                "float or double (.ply and .pcd; default: float where it keeps every digit; PCL's types want float)", "Points");
  parser.option("--resolution", flags.resolution, "UNITS",
                "coordinates become multiples of it (.las; 1e-9 .. 1000; default 0.0001, or the finest power of ten that fits the extent)", "Points");
  parser.option("--las", flags.las, "VERSION", "1.2 or 1.4 (default: 1.2, and 1.4 for more than 4,294,967,295 points)", "Points");
  parser.option("--scan", flags.scan, "K", "only this scan, counted from 0 as in stations.csv", "Points");
  parser.option("--crs", flags.crs, "EPSG:CODE", "projected coordinate system of the numbers (.las, .geojson; default: that of the file)", "Points");
  parser.option("--array", flags.array, "NAME", "which array of a field (.vti, .npy, .bt, .vdb; default: all, the only one, state)", "Fields");
  parser.flag("--force", flags.force, "replace OUT", "Output");
  parser.flag("--json", flags.json, "print what was written as JSON", "Output");
  parser.flag("-q,--quiet", flags.quiet, "print nothing", "Output");
  if (!parser.parse(arguments)) return 0;
  require(!flags.in.empty(), "IN is missing");
  require(!flags.out.empty(), "OUT is missing");
  require(flags.force || !fs::exists(flags.out), "is there already; --force replaces it", flags.out);
  const Written written = converted(flags);
  write_file(flags.out, written.bytes);
  Json result = {{"file", flags.out}, {"bytes", written.bytes.size()}};
  result.update(written.figures);
  result["left_out"] = written.left_out;
  if (flags.json) fmt::print("{}", as_text(result));
  if (flags.quiet) return 0;
  if (!flags.json) fmt::print("{}: {}\n", flags.out, written.sentence);
  if (!written.left_out.empty()) fmt::print(stderr, "vantage: {} does not hold: {}\n", flags.out, fmt::join(written.left_out, "; "));
  return 0;
}
