// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "arguments.h"
#include "commands.h"
#include "summary.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/exchanged.h"
#include "vantage/surface/surface.h"

namespace {

constexpr const char* kPurpose =
    "Writes scans as a compact map to exchange with other vehicles: one delta a scan, each with what it adds to the ones before, within a\n"
    "certified error: no measured point is farther than eta from the map, and no place of the map farther than eta from a point. Reads what\n"
    "reconstruct reads; each cloud, and each scan of a log, is a delta. docs/9-exchange.md has the format.\n";

constexpr const char* kExamples =
    "  vantage publish scan0.pcd scan1.pcd --source car -o car.vmap\n"
    "  vantage publish scan2.pcd --source car --onto car.vmap -o car.vmap\n"
    "  vantage merge car.vmap bus.vmap -o all.vmap";

}  // namespace

int publish_command(const Arguments& arguments) {
  CommandParser parser("publish", "CLOUD… -o MAP [options]", kPurpose, kExamples);
  std::vector<std::string> clouds;
  std::string path, onto, source, eta, threads;
  bool json = false, quiet = false;
  vantage::SurfaceOptions options;
  parser.app().add_option("CLOUD", clouds, "point clouds, scan logs or run folders");
  parser.option("-o,--output", path, "MAP", ".vmap", "Output");
  parser.option("--onto", onto, "MAP", "go on after this map, and write its deltas too", "Output");
  parser.flag("--json", json, "print the figures as JSON", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing", "Output");
  parser.option("--source", source, "NAME", "of the vehicle, different from all others (default: that of the file)", "Method");
  parser.option("--eta", eta, "METRES", "largest certified error (default 0.1)", "Method");
  parser.option("--threads", threads, "N", "at most so many threads (default: all cores)", "Method");
  if (!parser.parse(arguments)) return 0;
  vantage::require(!clouds.empty(), "CLOUD is missing");
  vantage::require(path.ends_with(".vmap"), path.empty() ? "MAP is missing" : fmt::format("{}: must end in .vmap", path), "-o");
  if (!eta.empty()) set_options(list_options(options), "surface", {"surface.eta=" + eta});
  if (source.empty()) source = std::filesystem::path(path).stem().string();
  const vantage::ThreadLimit limit(threads.empty() ? 0 : static_cast<int>(whole_number("--threads", threads, 1, 1024)));
  const vantage::ExchangeMap before = onto.empty() ? vantage::ExchangeMap() : vantage::read_map(onto);
  const std::vector<std::filesystem::path> paths(clouds.begin(), clouds.end());
  const vantage::ExchangeMap map = vantage::published_scans(vantage::read_scans(paths), source, options.eta, before);
  vantage::write_file(path, map.bytes());
  if (!quiet)
    fmt::print("{}", json ? vantage::as_text(describe_map(map, path)) : fmt::format("{}: {}\n", path, map_sentence(describe_map(map, path))));
  return 0;
}
