// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next.h"

#include <fmt/format.h>

#include <array>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/next_answer.h"
#include "vantage/session/next_measured.h"
#include "vantage/session/next_options.h"
#include "vantage/session/next_rule.h"
#include "vantage/session/next_zones.h"
#include "vantage/session/playback.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scan_log.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// A run of `vantage explore`, asked again with a person's wishes.
template <int Dim>
NextOutcome of_explored(const NextRequest& request, const World& world, const Scene<Dim>& scene, Observer* observer) {
  const NextSetup setup = next_setup(request.settings);
  check_lists<Dim>(setup.next);
  require(std::array{false, true}[Dim - 2] || (setup.next.height == 0.0 && setup.next.stand != NextOptions::Stand::ground), "a plane has no heights",
          "--height");
  require(setup.next.moved == NextOptions::Moved::keep, "of a person's scans: in a built scene nothing moves", "--moved");
  const Scenario scenario = with_settings(
      world.scenario,
      [&] {
        std::vector<Setting> own;
        for (const Setting& setting : request.settings)
          if (!setting.name.starts_with("next.") && !setting.name.starts_with("measured.")) own.push_back(setting);
        return own;
      }(),
      world.scene);
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(request.folder / run_file::kScanLog);
  require(log.size() > 0, "the run has no scans yet", request.folder.string());
  ExploreOptions options = scenario.explore;
  options.snapshots = false;
  options.max_scans = log.size() + 1;
  Playback<Dim> playback([&](int k) { return log.read(k); });
  Explorer<Dim> explorer(playback, scene.domain, Eigen::Map<const Vec<Dim>>(scenario.start.data()), options, observer);
  require_met<Dim>(setup.next, scene.domain, request.settings);
  NextOutcome outcome;
  explorer.set_rule(station_rule<Dim>(setup.next, options.planner.clearance, false, outcome.notes));
  play(explorer, log.size(), observer);
  const NextAnswer<Dim> answer = next_answer<Dim>(explorer, setup.next, [&](int k) { return log.read(k); }, outcome.notes);
  outcome.json = answer_json(answer, explorer);
  outcome.folder = request.folder;
  outcome.unreachable = answer.ranked.empty() && !answer.verdict.complete;
  write_file(request.folder / run_file::kNext, as_text(outcome.json));
  write_file(request.folder / run_file::kNextTable, next_csv(answer));
  return outcome;
}

/// Files of zones are read once: later commands know what they held.
void settle_zones(std::vector<Setting>& settings) {
  const MeasuredOptions measured = next_setup(settings).measured;
  for (Setting& setting : settings)
    if (setting.name == "next.keep_out" || setting.name == "next.must_see") setting.value = settled_zones(setting.value, measured, setting.where);
}

}  // namespace

NextOutcome find_next(const NextRequest& given, Observer* observer) {
  NextRequest request = given;
  require(!request.inputs.empty(), "no scans are named: point clouds, or a run folder");
  const ThreadLimit limit(request.threads);
  settle_zones(request.settings);
  std::span<const fs::path> files(request.inputs);
  if (fs::path& first = request.inputs.front(); first.filename() == run_file::kScanLog && is_run_folder(fs::absolute(first).parent_path()))
    first = fs::absolute(first).parent_path();  // The log of a run stands for its folder.
  if (restore_replaced_run(request.inputs.front()) && observer != nullptr)
    observer->warn(fmt::format("{}: the run that was to be replaced is back", request.inputs.front().string()));
  const bool exists = is_run_folder(request.inputs.front()) && !has_only_begun(request.inputs.front());
  if (exists) {
    require(request.folder.empty() || fs::weakly_canonical(request.folder) == fs::weakly_canonical(request.inputs.front()),
            "-o: the scans are added to the folder that is named first", request.inputs.front().string());
    request.folder = request.inputs.front();
    files = files.subspan(1);
  }
  for (const fs::path& file : files)
    require(!fs::is_directory(file), exists ? "a folder: only files can be added to a run" : "a folder, and not a run", file.string());
  require(exists || request.remove.empty(), "--remove: only of a run folder");
  require(!files.empty() || (request.poses.list.empty() && request.poses.at.empty()), "--poses, --at: no scans are added");
  if (exists && !fs::exists(request.folder / run_file::kNextSettings)) {
    require(files.empty() && request.remove.empty(),
            "a run of vantage explore: its scans are simulated, a person's cannot be added or taken out here", request.folder.string());
    const World world = make_world((request.folder / run_file::kScenario).string(), {});
    return std::visit([&](const auto& scene) { return of_explored(request, world, scene, observer); }, world.scene);
  }
  if (!exists && !request.folder.empty()) {
    require(!is_run_folder(request.folder) || has_only_begun(request.folder),
            fmt::format("a run is there already: vantage next {} FILE adds a scan to it", request.folder.string()), request.folder.string());
    check_run_folder(request.folder, FolderMode::fresh);
  }
  return next_of_measured(request, files, exists, observer);
}

}  // namespace vantage
