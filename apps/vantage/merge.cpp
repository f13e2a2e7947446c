// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "arguments.h"
#include "commands.h"
#include "summary.h"
#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/exchanged.h"

namespace {

constexpr const char* kPurpose =
    "Puts the deltas of several maps into one. Neither the order nor repetition matters: vehicles that hold the same deltas have the same\n"
    "bytes. Writes .vmap, or the surfaces as .ply or .glb.\n";

constexpr const char* kExamples =
    "  vantage merge car.vmap bus.vmap -o all.vmap\n"
    "  vantage merge car.vmap --without bus.vmap -o news.vmap      what the bus does not have yet\n"
    "  vantage merge all.vmap -o all.glb";

}  // namespace

int merge_command(const Arguments& arguments) {
  CommandParser parser("merge", "MAP… -o FILE [options]", kPurpose, kExamples);
  std::vector<std::string> maps;
  std::string path, without;
  bool json = false, quiet = false;
  parser.app().add_option("MAP", maps, "maps that publish or merge wrote");
  parser.option("-o,--output", path, "FILE", ".vmap, .ply or .glb", "Output");
  parser.option("--without", without, "MAP", "leave out the deltas that this map holds", "Output");
  parser.flag("--json", json, "print the figures as JSON", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing", "Output");
  if (!parser.parse(arguments)) return 0;
  vantage::require(!maps.empty(), "MAP is missing");
  const bool surface = path.ends_with(".ply") || path.ends_with(".glb");
  vantage::require(surface || path.ends_with(".vmap"), path.empty() ? "FILE is missing" : fmt::format("{}: must end in .vmap, .ply or .glb", path),
                   "-o");
  vantage::ExchangeMap all;
  for (const std::string& name : maps) {
    const vantage::ExchangeMap map = vantage::read_map(name);
    vantage::require(all.empty() || map.empty() || map.dim() == all.dim(),
                     fmt::format("a map of {} dimensions beside one of {}", map.dim(), all.dim()), name);
    all.merge(map);
  }
  if (!without.empty()) all = all.without(vantage::read_map(without));
  const vantage::Json figures = describe_map(all, path);
  vantage::write_file(path, surface ? map_as_surface(all, path, path) : all.bytes());
  if (!quiet) fmt::print("{}", json ? vantage::as_text(figures) : fmt::format("{}: {}\n", path, map_sentence(figures)));
  return 0;
}
