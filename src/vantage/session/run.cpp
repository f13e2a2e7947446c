// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/run.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <numeric>
#include <thread>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/version.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/json_text.h"
#include "vantage/session/logged_sensor.h"
#include "vantage/session/outputs.h"
#include "vantage/session/scenario_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A run while it goes on, in its dimension.
template <int Dim>
class Run {
 public:
  Run(const RunRequest& request, const Scenario& scenario, const Scene<Dim>& scene, RunObserver* observer)
      : request_(request), scenario_(scenario), scene_(scene), observer_(observer), lidar_(scene.mesh, scenario.sensor), sensor_(make_sensor()) {}

  RunOutcome go() {
    ExploreOptions options = scenario_.explore;
    if (request_.max_scans) options.max_scans = *request_.max_scans;
    const int logged = sensor_.size();
    require(logged <= options.max_scans, fmt::format("--max-scans {}: the run has {} scans already", options.max_scans, logged),
            request_.folder.string());
    const Vec<Dim> start = Eigen::Map<const Vec<Dim>>(scenario_.start.data());
    Explorer<Dim> explorer(sensor_, scene_.domain, start, options, observer_);
    if (observer_ != nullptr) observer_->begin({scene_.name, Dim, explorer.window().size(), logged, options.max_scans});

    bool stopped = false;
    while (!explorer.finished() && !stopped) {
      take_step(explorer, logged);
      stopped = observer_ != nullptr && observer_->stop_requested();
    }
    if (new_folder_) new_folder_->keep();
    return save(explorer, stopped && !explorer.finished());
  }

 private:
  LoggedSensor<Dim> make_sensor() {
    const fs::path log = request_.folder / run_file::kScanLog;
    if (request_.mode == FolderMode::resume) {
      ScanLog<Dim> opened = ScanLog<Dim>::open(log, observer_);
      clean_run_folder(request_.folder);
      return LoggedSensor<Dim>(lidar_, std::move(opened));
    }
    return LoggedSensor<Dim>(lidar_, [this, log] {  // The first scan has succeeded: only now is there something to keep.
      new_folder_.emplace(request_.folder);
      ScanLog<Dim> created = ScanLog<Dim>::create(log);  // First, for whoever holds the log has the folder.
      new_folder_->own();
      write_file(request_.folder / run_file::kScenario, scenario_as_toml(scenario_, false));
      write_file(request_.folder / run_file::kManifest, as_text(manifest_json(scenario_, scene_)));
      return created;
    });
  }

  void take_step(Explorer<Dim>& explorer, int logged) {
    const Clock::time_point begin = Clock::now();
    const StepRecord<Dim>& step = explorer.step();
    if (new_folder_) new_folder_->keep();  // A first step that fails as a whole leaves nothing behind; from here on the scans stay.
    path_ += step.path_length;
    step_seconds_.push_back(seconds_since(begin));
    if (observer_ == nullptr) return;
    observer_->step({step.scan,
                     step.scan < logged,
                     {step.vantage.data(), step.vantage.data() + Dim},
                     step.points,
                     step.new_volume,
                     step.seen_fraction,
                     path_,
                     step_seconds_.back()});
  }

  RunOutcome save(const Explorer<Dim>& explorer, bool interrupted) {
    const RunOutputs<Dim> outputs{scenario_, scene_, explorer, sensor_.log()};
    const Clock::time_point begin = Clock::now();
    save_outputs(request_.folder, outputs, observer_);
    const double saving = seconds_since(begin);
    write_file(request_.folder / run_file::kTiming, as_text(timing(explorer, saving)));
    return {end_of(explorer, interrupted), request_.folder, result_json(outputs), seconds_since(begin_)};
  }

  [[nodiscard]] RunEnd end_of(const Explorer<Dim>& explorer, bool interrupted) const {
    if (interrupted) return RunEnd::interrupted;
    if (explorer.verdict().complete) return RunEnd::finished;
    const std::int64_t limit = request_.max_scans.value_or(scenario_.explore.max_scans);
    return static_cast<std::int64_t>(explorer.steps().size()) >= limit ? RunEnd::scan_limit : RunEnd::no_plan;
  }

  [[nodiscard]] Json timing(const Explorer<Dim>& explorer, double saving) const {
    std::map<std::string, double> stages;
    Json steps = Json::array();
    for (const StepRecord<Dim>& step : explorer.steps()) {
      for (const auto& [stage, seconds] : step.seconds) stages[stage] += seconds;
      steps.push_back({{"scan", step.scan}, {"seconds", step_seconds_.at(static_cast<std::size_t>(step.scan))}, {"stages", step.seconds}});
    }
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return {{"vantage", kVersion},
            {"ended", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()))},
            {"threads", request_.threads > 0 ? request_.threads : static_cast<int>(std::thread::hardware_concurrency())},
            {"peak_memory_mib", static_cast<double>(usage.ru_maxrss) / 1024.0},
            {"seconds", {{"all", seconds_since(begin_)}, {"saving", saving}, {"stages", stages}}},
            {"steps", steps}};
  }

  const RunRequest& request_;
  const Scenario& scenario_;
  const Scene<Dim>& scene_;
  RunObserver* observer_;
  Clock::time_point begin_ = Clock::now();
  std::optional<NewFolder> new_folder_;
  SimulatedLidar<Dim> lidar_;
  LoggedSensor<Dim> sensor_;
  double path_ = 0.0;
  std::vector<double> step_seconds_;
};

/// `runs/town` for `town:seed=3`, `runs/city` for `models/city.obj+ground.obj` and for `city.toml`.
fs::path default_folder(const std::string& scene) {
  require(!scene.empty(), "no scene is named");
  const fs::path first = scene.substr(0, scene.find_first_of("+:"));
  return fs::path("runs") / first.stem();
}

/// The scene must still be the one that was explored.
template <int Dim>
void check_input(const fs::path& folder, const Scenario& scenario, const Scene<Dim>& scene) {
  const fs::path path = folder / run_file::kManifest;
  const Json manifest = parse_json<Json>(read_file(path), path.string());
  require(manifest.is_object() && manifest.contains("inputs"), "not a manifest", path.string());
  require(manifest["inputs"] == manifest_json(scenario, scene)["inputs"], fmt::format("{} is not what it was when the run began", scenario.scene),
          path.string());
}

/// The world of a run folder; what the request says must not contradict it.
World resumed_world(const RunRequest& request) {
  const fs::path file = request.folder / run_file::kScenario;
  World world = make_world(file.string(), {});
  const Scenario wanted = with_settings(world.scenario, joined_settings(request.scene, request.settings), world.scene);
  const std::vector<std::string> found = differences(wanted, world.scenario);
  if (!found.empty()) throw Error(ErrorCode::bad_input, found.front() + ": a resumed run keeps its options", file.string());
  std::visit([&](const auto& scene) { check_input(request.folder, world.scenario, scene); }, world.scene);
  return world;
}

}  // namespace

RunOutcome run_exploration(const RunRequest& given, RunObserver* observer) {
  RunRequest request = given;
  require(request.remove.empty() || request.mode == FolderMode::resume, "--remove: only with --resume");
  require(!request.max_scans || *request.max_scans >= 1, fmt::format("--max-scans {}: must be >= 1", request.max_scans.value_or(0)));
  if (request.folder.empty()) request.folder = default_folder(request.scene);
  if (restore_replaced_run(request.folder) && observer != nullptr)
    observer->warn(
        fmt::format("{}: the run that was to be replaced is back: the new one was stopped before its first scan", request.folder.string()));
  if (request.mode == FolderMode::resume && !request.scene.empty() && has_only_begun(request.folder)) request.mode = FolderMode::fresh;
  check_run_folder(request.folder, request.mode);
  const ThreadLimit limit(request.threads);
  const World world = request.mode == FolderMode::resume ? resumed_world(request) : make_world(request.scene, request.settings);
  return std::visit(
      [&]<int Dim>(const Scene<Dim>& scene) {
        if (!request.remove.empty()) remove_scans<Dim>(request.folder / run_file::kScanLog, request.remove);
        return Run<Dim>(request, world.scenario, scene, observer).go();
      },
      world.scene);
}

}  // namespace vantage
