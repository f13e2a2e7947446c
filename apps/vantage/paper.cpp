// SPDX-License-Identifier: Apache-2.0
#include "paper.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "arguments.h"
#include "line_progress.h"
#include "progress.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"
#include "vantage/io/atomic_file.h"

using namespace vantage;

namespace {

struct Entry {
  std::string_view name, what;
  PaperItem (*make)(const PaperSetup&, Observer&);
};

/// What is made; a further one is a line here and a file of its own.
constexpr Entry kEntries[] = {
    {"fig2", "step by step in the plane, the outlines known and the metric E, by four forms of E", paper_fig2},
    {"fig3", "cylinders in a ring: the planned vantage points and their symmetry", paper_fig3},
    {"fig4", "cylinders: decay of the metric, scans against the number of cylinders with a line through them", paper_fig4},
    {"fig5", "patio: the scene, the integrated visibility, the points and the coarse reconstruction", paper_fig5},
    {"fig6", "patio: the scene beside the reconstruction from the visibility, close up", paper_fig6},
    {"fig7", "church: the reconstruction from all that was scanned", paper_fig7},
    {"table1", "Table I: the surfaces of patio and church, the paper's rows beside ours", paper_table1},
};

constexpr const char* kPurpose =
    "Makes a table or a figure of the paper again, from the built-in scenes, with our figures beside the printed ones.\n"
    "The table has lengths in both units: of the cube that holds the scene, as in the paper, and metres.\n\n";

constexpr const char* kExamples =
    "  vantage paper table1                the table on the terminal, as Markdown\n"
    "  vantage paper table1 -o table1      and in files: table1.md, table1.json, a picture of each surface\n"
    "  vantage paper fig4 -o fig4          numbers and pictures of Fig. 4\n"
    "  vantage paper fig4 --quick          a look at it in a few seconds\n"
    "  vantage paper table1 --json";

std::string names() {
  std::string out;
  for (const Entry& entry : kEntries) out += fmt::format("{}{}", out.empty() ? "" : ", ", entry.name);
  return out;
}

const Entry& find_entry(const std::string& name) {
  const auto entry = std::find_if(std::begin(kEntries), std::end(kEntries), [&](const Entry& e) { return e.name == name; });
  if (entry != std::end(kEntries)) return *entry;
  require(!name.empty(), fmt::format("NAME is missing: must be one of {}", names()));
  throw Error(ErrorCode::bad_input, fmt::format("{}: not a table or figure we make: must be one of {}", name, names()));
}

/// All files or, as far as can be known beforehand, none.
void write_files(const std::filesystem::path& folder, const PaperItem& item) {
  for (const auto& [name, bytes] : item.files) write_file(folder / name, bytes);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) throw Error(ErrorCode::io, "not a folder, and cannot be made one", folder.string());
}

}  // namespace

int paper_command(const Arguments& arguments) {
  std::string purpose = kPurpose;
  for (const Entry& entry : kEntries) purpose += fmt::format("  {:<8} {}\n", entry.name, entry.what);
  CommandParser parser("paper", "NAME [-o DIR] [options]", purpose, kExamples);
  std::string name, folder, step, threads;
  bool json = false, quiet = false, quick = false;
  parser.app().add_option("NAME", name, names());
  parser.option("-o,--output", folder, "DIR", "folder for the files", "Output");
  parser.flag("--json", json, "print the figures as JSON", "Output");
  parser.flag("-q,--quiet", quiet, "print nothing", "Output");
  parser.option("--step-deg", step, "DEGREES", "between the sensor's rays (0.01 .. 30 deg; default 0.5, the paper's; with --quick 2)", "Method");
  parser.flag("--quick", quick, "a coarser and smaller version of a figure, in seconds", "Method");
  parser.option("--threads", threads, "N", "at most so many threads (default: all cores); the results do not depend on it", "Method");
  if (!parser.parse(arguments)) return 0;
  const Entry& entry = find_entry(name);
  const ThreadLimit limit(threads.empty() ? 0 : static_cast<int>(whole_number("--threads", threads, 1, 1024)));
  PaperSetup setup{{}, quick, !folder.empty()};
  if (quick) setup.sensor.pattern.step = radians(2.0);
  if (!step.empty()) set_options(list_options(setup.sensor), "sensor", {"sensor.step_deg=" + step});
  if (!folder.empty()) make_folder(folder);
  const StopSignals signals;
  const PaperItem item = [&] {
    LineProgress progress(quiet);
    return entry.make(setup, progress);
  }();
  if (!folder.empty()) write_files(folder, item);
  if (json)
    fmt::print("{}", as_text(item.json));
  else if (!quiet)
    fmt::print("{}", item.text);
  return 0;
}
