// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "arguments.h"
#include "commands.h"
#include "line_progress.h"
#include "progress.h"
#include "summary.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/glb.h"
#include "vantage/io/obj.h"
#include "vantage/io/patch_file.h"
#include "vantage/session/clouds.h"
#include "vantage/session/result.h"
#include "verify.h"

namespace {

constexpr const char* kPurpose =
    "Fits surfaces to point clouds within a certified error: no measured point is farther than eta from the surface, and no place of the\n"
    "surface farther than eta from a point. Points that no surface explains stay as points. Reads PLY, PCD, XYZ, CSV, scan logs and run folders;\n"
    "several clouds count as one. Writes .ply (polygons, segments and points with the error of each), .glb or .obj. With --verify the certificate "
    "is\n"
    "compared with every point and every patch by a program of its own.\n";

constexpr const char* kExamples =
    "  vantage reconstruct scan0.pcd scan1.pcd --eta 0.05 -o surface.ply\n"
    "  vantage reconstruct runs/town --eta 0.2 -o coarse.glb\n"
    "  vantage reconstruct cloud.xyz --json        figures only\n"
    "  vantage reconstruct cloud.xyz --verify      and check them\n"
    "Exit: 0 done, 1 the certificate is wrong (--verify), 2 bad input, 3 files, 4 memory, 130 stopped.";

struct Flags {
  std::string path, eta, threads, filter;
  bool json = false, quiet = false, paper = false, verify = false;
};

/// What came out, and whether it holds.
struct Outcome {
  vantage::Json surface;
  std::optional<vantage::CertificateReport> report;
};

template <int Dim>
vantage::CertificateReport verify(std::span<const vantage::ScannedPoints<Dim>> scans, const std::vector<vantage::Patch<Dim>>& patches,
                                  const vantage::HausdorffTree<Dim>& tree, bool quiet) {
  const vantage::SurfaceStatistics s = tree.statistics();
  const StopSignals signals;
  LineProgress progress(quiet);
  return vantage::check_certificate<Dim>(vantage::joined<Dim>(scans), patches, {s.eta, s.data_to_surface, s.surface_to_data, !tree.options().paper},
                                         &progress);
}

template <int Dim>
std::string file_bytes(const std::vector<vantage::Patch<Dim>>& patches, const std::string& path) {
  if (path.ends_with(".glb")) return vantage::surface_as_glb<Dim>(patches, {});
  return path.ends_with(".obj") ? vantage::patches_as_obj<Dim>(patches) : vantage::patches_as_ply<Dim>(patches);
}

template <int Dim>
Outcome reconstruct(const std::vector<vantage::ScannedPoints<Dim>>& scans, const vantage::SurfaceOptions& options, const Flags& flags) {
  const std::string& path = flags.path;
  vantage::Box<Dim> box;
  for (const vantage::ScannedPoints<Dim>& scan : scans)
    for (const vantage::Vec<Dim>& p : scan.points)
      if (p.allFinite()) box.extend(p);
  vantage::require(!box.empty(), "the clouds have no finite point");
  // A little larger than the points, so that none lies on its very faces.
  vantage::HausdorffTree<Dim> tree(box.grown(0.001 * box.size().maxCoeff() + 1e-6), options);
  for (const vantage::ScannedPoints<Dim>& scan : scans) tree.insert(scan.points, scan.sensor);
  const std::vector<vantage::Patch<Dim>> patches = tree.patches();
  if (!path.empty()) vantage::write_file(path, file_bytes<Dim>(patches, path));
  Outcome outcome{to_json(tree.statistics()), {}};
  outcome.surface["dim"] = Dim;
  if (flags.verify) {
    outcome.report = verify<Dim>(scans, patches, tree, flags.quiet);
    outcome.surface["verify"] = to_json(*outcome.report);
  }
  return outcome;
}

int print_outcome(const Outcome& outcome, const Flags& flags) {
  const vantage::Json& surface = outcome.surface;
  if (flags.json)
    fmt::print("{}", vantage::as_text(surface));
  else if (!flags.quiet)
    fmt::print("{}{}\n{}", flags.path.empty() ? "" : flags.path + ": ", surface_sentence(surface, surface["dim"].get<int>()),
               outcome.report ? verify_text(*outcome.report) : "");
  if (!flags.json && !flags.quiet && surface.contains("filter"))
    fmt::print("  filter    {} mixed pixels and {} isolated points of {} left out\n", surface["filter"]["mixed"].get<std::int64_t>(),
               surface["filter"]["isolated"].get<std::int64_t>(), surface["filter"]["points"].get<std::int64_t>());
  if (!outcome.report || outcome.report->holds()) return 0;
  std::fflush(stdout);
  fmt::print(stderr, "vantage: the certificate is wrong: {}\n", outcome.report->faults.front());
  return kWrongCertificate;
}

}  // namespace

int reconstruct_command(const Arguments& arguments) {
  CommandParser parser("reconstruct", "CLOUD… [-o FILE] [options]", kPurpose, kExamples);
  std::vector<std::string> clouds, sets;
  Flags flags;
  vantage::SurfaceOptions options;
  parser.app().add_option("CLOUD", clouds, "point clouds, scan logs or run folders");
  parser.option("-o,--output", flags.path, "FILE", ".ply, .glb or .obj", "Output");
  parser.flag("--json", flags.json, "print the figures as JSON", "Output");
  parser.flag("-q,--quiet", flags.quiet, "print nothing", "Output");
  for (const vantage::Option& option : list_options(options))
    if (option.name == "eta")
      parser.option("--eta", flags.eta, "METRES", fmt::format("{} ({}; default {})", option.doc, option.allowed(), option.text()), "Method");
  parser.option("--filter", flags.filter, "WHAT",
                "points left out (none | mixed | isolated | both); needs to know where each scan was taken: E57, PTX, PCD, logs", "Method");
  parser.flag("--paper", flags.paper, "the paper's own behaviour: small cells dropped, best fit kept at the depth limit (surface.paper)", "Method");
  parser.flag("--verify", flags.verify, "check the certificate: every point against all patches, every patch against all points", "Method");
  parser.app()
      .add_option("--set", sets, "any option of the stage surface (vantage config dump lists them), and measured.filter_*")
      ->type_name("STAGE.OPTION=VALUE")
      ->group("Method");
  parser.option("--threads", flags.threads, "N", "at most so many threads (default: all cores)", "Method");
  if (!parser.parse(arguments)) return 0;
  vantage::require(!clouds.empty(), "CLOUD is missing");
  const bool known = flags.path.ends_with(".ply") || flags.path.ends_with(".glb") || flags.path.ends_with(".obj");
  vantage::require(flags.path.empty() || known, fmt::format("{}: must end in .ply, .glb or .obj", flags.path), "-o");
  if (!flags.eta.empty()) sets.push_back("surface.eta=" + flags.eta);
  if (flags.paper) sets.emplace_back("surface.paper=true");
  vantage::FilterOptions filter;
  const auto of_filter = std::stable_partition(sets.begin(), sets.end(), [](const std::string& set) { return !set.starts_with("measured."); });
  set_options(list_options(filter), "measured", {of_filter, sets.end()});
  if (!flags.filter.empty()) set_options(list_options(filter), "measured", {"measured.filter=" + flags.filter});
  check_options(filter, "measured");
  sets.erase(of_filter, sets.end());
  set_options(list_options(options), "surface", sets);
  const vantage::ThreadLimit limit(flags.threads.empty() ? 0 : static_cast<int>(whole_number("--threads", flags.threads, 1, 1024)));
  const std::vector<std::filesystem::path> paths(clouds.begin(), clouds.end());
  vantage::FilterReport filtered;
  const vantage::AnyScans scans = vantage::read_scans(paths, filter, &filtered);
  Outcome outcome = std::visit([&](const auto& s) { return reconstruct(s, options, flags); }, scans);
  if (filter.what != vantage::FilterOptions::What::none)
    outcome.surface["filter"] = {{"points", filtered.points}, {"mixed", filtered.mixed}, {"isolated", filtered.isolated}};
  return print_outcome(outcome, flags);
}
