// SPDX-License-Identifier: Apache-2.0
// Planning quality against the greedy oracle (audit/oracle.h), a row a run:
//   bench_planning --scenes planar,discs,pipes:cylinders=6 --starts 5 --set planner.metric=boundary
// n90, n95, n99: scans until that share of the reachable visible volume is seen, `-` if never; oracle: its n99; idle: picks that gained next to
// nothing.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "vantage/audit/trial.h"
#include "vantage/base/error.h"

namespace vantage {
namespace {

struct Settings {
  std::vector<std::string> scenes{"planar", "discs", "pipes:cylinders=6"};
  std::vector<std::string> sets;
  std::int64_t starts = 5, seed = 2026, candidates = 1000, targets = 20000;
  double voxel = 0.0;        ///< 0: the scene's.
  double cap = 3.0;          ///< Scans of a run at most, in those of its oracle.
  bool to_the_end = false;   ///< Run on after 99 %, to judge the verdict.
  bool scene_start = false;  ///< The first start is the scene's own.
  bool curves = false;       ///< Places and shares after each scan.
};

/// `stage.name=value` into the options of a trial.
void apply(TrialOptions& o, const std::string& text) {
  const std::size_t dot = text.find('.'), equals = text.find('=');
  require(dot < equals && equals != std::string::npos, fmt::format("--set {}: must be stage.option=value", text));
  const std::string stage = text.substr(0, dot), name = text.substr(dot + 1, equals - dot - 1), value = text.substr(equals + 1);
  const auto assign = [&](std::vector<Option> options) {
    for (Option& option : options)
      if (option.name == name) return option.parse(value, stage + "." + name);
    require(false, fmt::format("--set {}: {} has no option {}", text, stage, name));
  };
  if (stage == "explore") return assign(list_options(o.explore));
  if (stage == "surface") return assign(list_options(o.explore.surface));
  if (stage == "visibility") return assign(list_options(o.explore.visibility));
  if (stage == "planner") return assign(list_options(o.explore.planner));
  if (stage == "sensor") return assign(list_options(o.lidar));
  require(false, fmt::format("--set {}: stage must be explore, surface, visibility, planner or sensor", text));
}

std::string scans(std::optional<std::int64_t> n) { return n ? fmt::format("{}", *n) : "-"; }

struct Sum {
  std::int64_t runs = 0, missed = 0, ours = 0, oracle = 0, seen = 0, idle = 0, picks = 0;
  double worst = 0.0;
};

/// Place and share, scan by scan: of the run and of its oracle.
template <int Dim>
void curves(const RunScore<Dim>& run, const SightTable<Dim>& sight, const OracleRun& oracle) {
  const auto line = [](const char* who, std::size_t k, const Vec<Dim>& place, double share) {
    fmt::print("{:>24} {:>4}  {:.4f}  at {:.2f}\n", who, k + 1, share, fmt::join(place.begin(), place.end(), ", "));
  };
  for (std::size_t k = 0; k < run.coverage.size(); ++k) line("run", k, run.places[k], run.coverage[k]);
  for (std::size_t k = 0; k < oracle.coverage.size(); ++k) line("oracle", k, sight.candidates[oracle.places[k]], oracle.coverage[k]);
}

template <int Dim>
void row(const Trial<Dim>& trial, const Vec<Dim>& start, const TrialOptions& options, const Settings& settings, Sum& sum) {
  const OracleOptions sampling{.targets = settings.targets, .candidates = settings.candidates};
  const SightTable<Dim> sight = trial.sight_table(start, sampling);
  const OracleRun anywhere = greedy_oracle(sight), walking = greedy_oracle(sight, {.from_seen = true});
  const std::int64_t best = anywhere.scans_to(0.99).value_or(static_cast<std::int64_t>(anywhere.places.size()));
  const auto cap = std::max<std::int64_t>(static_cast<std::int64_t>(settings.cap * static_cast<double>(best)), 1);
  const auto begin = std::chrono::steady_clock::now();
  const RunScore<Dim> run = trial.run(start, options, {.max_scans = cap, .coverage = settings.to_the_end ? 2.0 : 0.99});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto n99 = run.scans_to(0.99);
  const double ratio = static_cast<double>(n99.value_or(cap)) / static_cast<double>(best);
  const std::int64_t idle = idle_picks(run.coverage);
  fmt::print("{:>24} {:>4} {:>4} {:>4} {:>7} {:>5} {:>6.2f} {:>5} {:>8.4f} {:>10.4g} {:>8} {:>8.2f}\n", sum.runs, scans(run.scans_to(0.9)),
             scans(run.scans_to(0.95)), scans(n99), best, scans(walking.scans_to(0.99)), ratio, idle, run.coverage.back(), run.falsely_free,
             run.finished ? (run.verdict_right ? "right" : "wrong") : "-", seconds);
  if (run.finished)
    fmt::print("{:>24} {} after {} scans: {} Seen {:.5f} .. {:.5f}, truly {:.5f}.\n", "", run.verdict.complete ? "complete" : "not complete",
               run.places.size(), run.verdict.reason, run.verdict.seen_low, run.verdict.seen_high, run.coverage.back());
  if (settings.curves) curves(run, sight, anywhere);
  std::fflush(stdout);
  sum.runs += 1;
  sum.missed += n99 ? 0 : 1;
  sum.ours += n99.value_or(cap);
  sum.oracle += best;
  sum.seen += walking.scans_to(0.99).value_or(best);
  sum.idle += idle;
  sum.picks += static_cast<std::int64_t>(run.coverage.size()) - 1;
  sum.worst = std::max(sum.worst, ratio);
}

template <int Dim>
void table(const std::string& name, const Scene<Dim>& scene, const Settings& settings) {
  TrialOptions options = trial_options(scene);
  if (settings.voxel > 0.0) options.explore.voxel = settings.voxel;
  for (const std::string& set : settings.sets) apply(options, set);
  const Trial<Dim> trial(scene, options);
  fmt::print("{:<24} {:>4} {:>4} {:>4} {:>7} {:>5} {:>6} {:>5} {:>8} {:>10} {:>8} {:>8}\n", name, "n90", "n95", "n99", "oracle", "(seen)", "ratio",
             "idle", "share", "false free", "verdict", "seconds");
  std::vector<Vec<Dim>> starts = trial.starts(settings.starts, settings.seed);
  if (settings.scene_start && !starts.empty()) starts[0] = scene.start;
  Sum sum;
  for (const Vec<Dim>& start : starts) row(trial, start, options, settings, sum);
  fmt::print("{:>24} {:>14} {:>7} {:>5} {:>6.2f} {:>5}   worst {:.2f}, missed {} of {}, idle {} of {} picks\n\n", "sum", sum.ours, sum.oracle,
             sum.seen, static_cast<double>(sum.ours) / static_cast<double>(sum.oracle), sum.idle, sum.worst, sum.missed, sum.runs, sum.idle,
             sum.picks);
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
  vantage::Settings settings;
  CLI::App app("Planning quality against the greedy oracle.");
  app.add_option("--scenes", settings.scenes, "names as in `vantage scene --list`")->delimiter(',');
  app.add_option("--starts", settings.starts, "random reachable starts in each")->check(CLI::Range(1, 10000));
  app.add_option("--seed", settings.seed, "of the starts");
  app.add_option("--set", settings.sets, "stage.option=value (explore, surface, visibility, planner, sensor)");
  app.add_option("--voxel", settings.voxel, "lattice spacing [m]; 0: the scene's");
  app.add_option("--candidates", settings.candidates, "of the oracle");
  app.add_option("--targets", settings.targets, "of the oracle");
  app.add_option("--cap", settings.cap, "scans of a run at most, over those of its oracle");
  app.add_flag("--to-the-end", settings.to_the_end, "run on after 99 % until the explorer stops");
  app.add_flag("--scene-start", settings.scene_start, "the first start is the scene's own");
  app.add_flag("--curves", settings.curves, "places and shares after each scan");
  CLI11_PARSE(app, argc, argv);
  try {
    for (const std::string& name : settings.scenes)
      std::visit([&](const auto& scene) { vantage::table(name, scene, settings); }, vantage::make_scene(name));
  } catch (const vantage::Error& error) {
    fmt::print(stderr, "bench_planning: {}\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}
