// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "arguments.h"
#include "audit_campaign.h"
#include "audit_generated.h"
#include "audit_report.h"
#include "audit_run.h"
#include "commands.h"
#include "progress.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/run_folder.h"

using namespace vantage;

namespace {

constexpr const char* kPurpose =
    "How few scans? Plays built-in places from many starts, with the planner as it stands and with others, beside oracles that know the\n"
    "map: greedy from anywhere, greedy from places seen before, greedy that must also see 99 % of the walls. Or scores one run folder.\n"
    "Every finished run is kept in AUDIT: the same command goes on where it was stopped.\n";

constexpr const char* kExamples =
    "  vantage audit planar discs                          three starts each, into audit/\n"
    "  vantage audit blocks office town2d --layouts 10 --variants all -o tables/rooms\n"
    "  vantage audit planar --variant calm=planner.lambda_factor=1,planner.rays=800\n"
    "  vantage audit runs/town --truth town --json         one run, beside oracles and baselines\n"
    "  vantage audit --generated 500                       small random scenes, each played to its end and checked\n"
    "Exit: 0 done, 130 stopped and kept, 2 bad input, 3 files, 4 memory.";

struct Flags {
  std::vector<std::string> places, sets, own;
  std::string truth, folder, variants, layouts, starts, seed, voxel, step, cap, targets, candidates, walls, bound, threads, generated, kinds, ground;
  bool scene_start = false, to_the_end = false, curves = false, json = false, quiet = false, verbose = false;
};

void add_flags(CommandParser& parser, Flags& flags) {
  const std::string what = "What", method = "Method", output = "Output";
  const auto several = [&](const char* name, std::vector<std::string>& values, const char* type, const std::string& help) {
    parser.app().add_option(name, values, help)->type_name(type)->allow_extra_args(false)->group(what);
  };
  parser.app().add_option("SCENE", flags.places, "scenes as for vantage explore, or one run folder");
  parser.option("--truth", flags.truth, "SCENE", "of a run folder: the true place (default: what the run explored)", what);
  parser.option("--layouts", flags.layouts, "N", "of each scene that is drawn from a seed: seeds 1 .. N (default 1)", what);
  parser.option("--starts", flags.starts, "N", "random reachable starts in each layout (default 3)", what);
  parser.flag("--scene-start", flags.scene_start, "the first start is the scene's own", what);
  std::string names;
  for (const Variant& variant : built_in_variants()) names += fmt::format("{}{}: {}", names.empty() ? "" : "; ", variant.name, variant.what);
  parser.option("--variants", flags.variants, "A,B", names + "; all (but octomap); none (default all; of a run folder optimistic,sight)", what);
  several("--variant", flags.own, "NAME=STAGE.OPTION=VALUE,..", "one more of your own (several: --variant A=… --variant B=…)");
  several("--set", flags.sets, "STAGE.OPTION=VALUE", "an option of every run; vantage config dump lists them");
  parser.option("--voxel", flags.voxel, "METRES", "lattice spacing of every run (default: the scene's)", what);
  parser.option("--step-deg", flags.step, "DEGREES", "between the sensor's rays", what);
  parser.option("--ground", flags.ground, "Z", "height of level ground that is added to mesh files which have none [m]", what);
  parser.option("--generated", flags.generated, "N",
                "instead of scenes: N small random ones, each to its end: does it end, is the verdict right, is the way free? --seed: of the first",
                what);
  parser.option("--kinds", flags.kinds, "A,B", "of generated scenes (default all): rooms, maze-2d, …", what);
  parser.flag("--to-the-end", flags.to_the_end, "go on after 99 % until the explorer stops, to judge its verdict", method);
  parser.option("--cap", flags.cap, "FACTOR", "scans of a run up to 99 %, at most, over those of its oracle (default 3)", method);
  parser.option("--seed", flags.seed, "N", "of the starts (default 2026)", method);
  parser.option("--targets", flags.targets, "N", "reference nodes the oracles look at (default 20000)", method);
  parser.option("--candidates", flags.candidates, "N", "places the oracles choose from (default 1000)", method);
  parser.option("--walls", flags.walls, "N", "places drawn on the true surface (default 10000)", method);
  parser.option("--bound", flags.bound, "N",
                "million elementary steps for a proof, beside the oracles, how few scans could do (default 3000; 0: none)", method);
  parser.option("--threads", flags.threads, "N", "at most so many threads (default: all cores); the results do not depend on it", method);
  parser.option("-o,--output", flags.folder, "AUDIT", "folder of the runs, audit.json and report.html (default audit)", output);
  parser.flag("--curves", flags.curves, "print place and share after every scan", output);
  parser.flag("--json", flags.json, "print audit.json (of a run folder: its score) instead of the table", output);
  parser.flag("-v,--verbose", flags.verbose, "a line for every generated scene", output);
  parser.flag("-q,--quiet", flags.quiet, "no progress, no table", output);
}

/// `value` if the option was given.
void take(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high, std::int64_t& value) {
  if (!text.empty()) value = whole_number(option, text, low, high);
}

std::vector<Setting> settings_of(const Flags& flags) {
  std::vector<Setting> settings;
  for (const std::string& set : flags.sets) settings.push_back(parse_setting(set, "--set"));
  if (!flags.voxel.empty()) settings.push_back({"explore.voxel", flags.voxel, "--voxel"});
  if (!flags.step.empty()) settings.push_back({"sensor.step_deg", flags.step, "--step-deg"});
  if (!flags.ground.empty()) settings.push_back({"scene.ground", flags.ground, "--ground"});
  return settings;
}

AuditPlan plan_of(const Flags& flags, bool run) {
  AuditPlan plan;
  plan.scenes = flags.places;
  plan.folder = flags.folder.empty() ? "audit" : flags.folder;
  plan.scene_start = flags.scene_start;
  plan.to_the_end = flags.to_the_end;
  plan.variants = chosen_variants(!flags.variants.empty() ? flags.variants
                                  : run                   ? "optimistic,sight"
                                  : flags.own.empty()     ? "all"
                                                          : "none",
                                  flags.own);
  take("--layouts", flags.layouts, 1, 10000, plan.layouts);
  take("--starts", flags.starts, 1, 10000, plan.starts);
  take("--seed", flags.seed, 0, 1'000'000'000, plan.seed);
  take("--targets", flags.targets, 1, 100'000'000, plan.oracle.targets);
  take("--candidates", flags.candidates, 1, 1'000'000, plan.oracle.candidates);
  take("--walls", flags.walls, 1, 100'000'000, plan.walls.places);
  take("--bound", flags.bound, 0, 1'000'000'000, plan.bound);
  if (!flags.cap.empty()) {
    const std::vector<double> cap = numbers("--cap", flags.cap);
    require(cap.size() == 1 && cap[0] >= 1.0 && cap[0] <= 1000.0, flags.cap + ": must be a number, 1 .. 1000", "--cap");
    plan.cap = cap[0];
  }
  plan.settings = settings_of(flags);
  return plan;
}

void print(const Flags& flags, const Json& json, const std::string& text) {
  if (flags.json)
    fmt::print("{}", as_text(json));
  else if (!flags.quiet)
    fmt::print("{}", text);
  std::fflush(stdout);
}

int score_run_folder(const Flags& flags) {
  require(flags.sets.empty() && flags.voxel.empty() && flags.step.empty() && flags.ground.empty(),
          "--set, --voxel, --step-deg, --ground: a run folder keeps its options");
  const AuditPlan plan = plan_of(flags, true);
  AuditProgress progress(flags.quiet);
  const Json score = audit_run(flags.places.front(), flags.truth, plan, progress);
  progress.finish();
  print(flags, score, score_text(score, flags.curves));
  return 0;
}

int play(const Flags& flags) {
  require(flags.truth.empty(), "--truth: only of a run folder");
  const AuditPlan plan = plan_of(flags, false);
  require(!plan.variants.empty(), "no variant is named", "--variants");
  AuditProgress progress(flags.quiet);
  const AuditOutcome outcome = play_audit(plan, progress);
  progress.finish();
  if (outcome.audit.at("scenes").empty()) throw Error(ErrorCode::interrupted, "stopped before the first run was finished");
  write_file(plan.folder / "timing.json", as_text(outcome.timing));
  write_file(plan.folder / "report.html", audit_report(outcome.audit));
  write_file(plan.folder / "audit.json", as_text(outcome.audit));
  print(flags, outcome.audit, audit_text(outcome.audit, outcome.timing, flags.curves) + fmt::format("{}\n", (plan.folder / "report.html").string()));
  if (outcome.complete) return 0;
  if (!flags.quiet) fmt::print(stderr, "vantage: stopped; the same command goes on\n");
  return static_cast<int>(ErrorCode::interrupted);
}

int play_small_scenes(const Flags& flags) {
  GeneratedPlan plan;
  plan.kinds = kinds_of(flags.kinds);
  plan.folder = flags.folder;
  plan.settings = settings_of(flags);
  take("--generated", flags.generated, 1, 100'000'000, plan.count);
  take("--seed", flags.seed, 0, 1'000'000'000, plan.seed);
  AuditProgress progress(flags.quiet);
  const GeneratedOutcome outcome = play_generated(plan, progress, [&](const Json& ending) {
    if (!flags.verbose || flags.quiet || flags.json) return;
    progress.finish();
    fmt::print("{}", ending_text(ending));
  });
  progress.finish();
  print(flags, outcome.json, generated_text(outcome.json));
  if (outcome.complete) return 0;
  if (!flags.quiet) fmt::print(stderr, "vantage: stopped{}\n", plan.folder.empty() ? "" : "; the same command goes on");
  return static_cast<int>(ErrorCode::interrupted);
}

}  // namespace

int audit_command(const Arguments& arguments) {
  CommandParser parser("audit", "SCENE… | RUN [options]", kPurpose, kExamples);
  Flags flags;
  add_flags(parser, flags);
  if (!parser.parse(arguments)) return 0;
  if (!flags.generated.empty()) {
    require(flags.places.empty(), "--generated: takes no SCENE");
    const ThreadLimit limit(flags.threads.empty() ? 0 : static_cast<int>(whole_number("--threads", flags.threads, 1, 1024)));
    const StopSignals signals;
    return play_small_scenes(flags);
  }
  require(flags.kinds.empty(), "--kinds: only with --generated");
  require(!flags.places.empty(), "SCENE is missing: vantage scene --list names some");
  const ThreadLimit limit(flags.threads.empty() ? 0 : static_cast<int>(whole_number("--threads", flags.threads, 1, 1024)));
  const StopSignals signals;
  const auto run = std::find_if(flags.places.begin(), flags.places.end(), [](const std::string& place) { return is_run_folder(place); });
  if (run == flags.places.end()) return play(flags);
  require(flags.places.size() == 1, *run + ": a run folder must stand alone");
  return score_run_folder(flags);
}
