// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "commands.h"
#include "progress.h"
#include "scenario_arguments.h"
#include "summary.h"
#include "vantage/base/error.h"

using vantage::FolderMode;
using vantage::RunEnd;

namespace {

constexpr const char* kPurpose =
    "Explores a place: scans, rebuilds the surfaces, works out what has been seen and what has not, goes to the place from which\n"
    "most of the rest will come into view, and scans again, until nothing more can be seen. Everything is made from RUN/scans.log,\n"
    "which is on the disk before a scan counts: Ctrl-C finishes the step and saves; --resume goes on and ends in the same bytes.\n";

constexpr const char* kExamples =
    "  vantage explore town                        the built-in town into runs/town\n"
    "  vantage explore pipes:cylinders=12 -o p     a parameter of a scene, and where to\n"
    "  vantage explore city.obj+ground.obj --eta 0.05 --range 60\n"
    "  vantage explore floorplan.yaml --start 12,8\n"
    "  vantage explore --resume -o runs/town       go on after Ctrl-C or --max-scans\n"
    "  vantage explore town --resume --remove 7    without scan 7\n"
    "Exit: 0 done, 130 stopped and saved, 6 unseen space remains and no plan reaches it, 2 bad input, 3 files, 4 memory.";

/// What the flags of `explore` hold.
struct Flags {
  std::string folder, max_scans, threads;
  std::vector<std::string> remove;
  bool resume = false, force = false, json = false, quiet = false, verbose = false;
};

void add_flags(CommandParser& parser, Flags& flags) {
  const std::string run = "Run", output = "Output";
  parser.option("-o,--output", flags.folder, "RUN", "run folder (default runs/NAME, with the name of the scene or file)", run);
  parser.option("--max-scans", flags.max_scans, "N", "stop after so many scans, this time (>= 1); a later --resume goes further", run);
  parser.flag("--resume", flags.resume, "go on with the run in RUN; its options stay (only --max-scans and --threads may differ)", run);
  parser.app()
      .add_option("--remove", flags.remove,
                  "with --resume: take scan K out of the log first (several: --remove 3 --remove 7); the log as it was stays in scans.log.bak")
      ->type_name("K")
      ->group(run);
  parser.flag("--force", flags.force, "replace the run in RUN", run);
  parser.option("--threads", flags.threads, "N", "at most so many threads (default: all cores); the results do not depend on it", run);
  parser.flag("--json", flags.json, "print result.json on stdout instead of the summary", output);
  parser.flag("-q,--quiet", flags.quiet, "no progress, no summary, no warnings", output);
  parser.flag("-v,--verbose", flags.verbose, "a line for every step", output);
}

vantage::RunRequest request_of(const Flags& flags, const ScenarioArguments& scenario) {
  vantage::require(!(flags.resume && flags.force), "--resume and --force: one of them");
  vantage::RunRequest request;
  request.scene = scenario.scene();
  request.settings = scenario.settings();
  request.folder = flags.folder;
  request.mode = flags.resume ? FolderMode::resume : flags.force ? FolderMode::replace : FolderMode::fresh;
  vantage::require(!request.scene.empty() || (flags.resume && !flags.folder.empty()), "SCENE is missing: vantage scene --list names some");
  if (!flags.max_scans.empty()) request.max_scans = whole_number("--max-scans", flags.max_scans, 1, 1'000'000);
  if (!flags.threads.empty()) request.threads = static_cast<int>(whole_number("--threads", flags.threads, 1, 1024));
  for (const std::string& index : flags.remove) request.remove.push_back(static_cast<int>(whole_number("--remove", index, 0, 1'000'000)));
  return request;
}

int exit_code(RunEnd end) {
  if (end == RunEnd::interrupted) return static_cast<int>(vantage::ErrorCode::interrupted);
  return end == RunEnd::no_plan ? static_cast<int>(vantage::ErrorCode::no_plan) : 0;
}

void print_outcome(const vantage::RunOutcome& outcome, const Flags& flags) {
  if (flags.json)
    fmt::print("{}", vantage::as_text(outcome.result));
  else if (!flags.quiet)
    fmt::print("{}", summary(outcome));
  std::fflush(stdout);
  if (outcome.end == RunEnd::no_plan) fmt::print(stderr, "vantage: {}\n", outcome.result["verdict"]["reason"].get<std::string>());
  if (outcome.end == RunEnd::interrupted && flags.json && !flags.quiet) fmt::print(stderr, "vantage: stopped; go on with {}\n", resume_hint(outcome));
}

}  // namespace

int explore_command(const Arguments& arguments) {
  CommandParser parser("explore", "SCENE [options]", kPurpose, kExamples);
  Flags flags;
  add_flags(parser, flags);
  ScenarioArguments scenario(parser);
  if (!parser.parse(arguments)) return 0;
  const vantage::RunRequest request = request_of(flags, scenario);
  const StopSignals signals;
  RunProgress progress(flags.quiet ? Loudness::quiet : flags.verbose ? Loudness::verbose : Loudness::normal);
  const vantage::RunOutcome outcome = run_exploration(request, &progress);
  progress.finish();
  print_outcome(outcome, flags);
  return exit_code(outcome.end);
}
