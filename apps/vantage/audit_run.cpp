// SPDX-License-Identifier: Apache-2.0
#include "audit_run.h"

#include <fmt/format.h>

#include <limits>

#include "audit_measures.h"
#include "vantage/base/error.h"
#include "vantage/session/run_folder.h"
#include "vantage/session/scan_log.h"

using namespace vantage;

namespace {

/// Plays a log.
template <int Dim>
class Playback final : public Sensor<Dim> {
 public:
  explicit Playback(const ScanLog<Dim>& log) : log_(log) {}
  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>& /*vantage_point*/, int index) override { return log_.read(index); }

 private:
  const ScanLog<Dim>& log_;
};

TrialOptions options_of(const Scenario& scenario, std::int64_t scans) {
  TrialOptions options{scenario.explore, scenario.sensor, false};
  options.explore.snapshots = false;
  options.explore.max_scans = std::max(options.explore.max_scans, scans);  // A run may have been given more by hand.
  return options;
}

/// The true place, explored as the run was.
template <int Dim>
Scene<Dim> true_scene(const World& world, const std::string& truth) {
  Scene<Dim> scene = std::get<Scene<Dim>>(world.scene);
  scene.start = Eigen::Map<const Vec<Dim>>(world.scenario.start.data());
  if (truth.empty()) return scene;
  const World other = make_world(truth, {});
  const auto* same = std::get_if<Scene<Dim>>(&other.scene);
  require(same != nullptr, fmt::format("--truth {}: must have {} dimensions, as the run has", truth, Dim));
  scene.mesh = same->mesh;
  scene.parts = same->parts;
  scene.name = same->name;
  return scene;
}

Json ratio(const Json& ours, const Json& theirs) {
  if (!ours.is_number() || !theirs.is_number()) return nullptr;
  return ours.get<double>() / theirs.get<double>();
}

/// Ratios to the first oracle by name, to the others and to the bound with theirs.
void add_ratios(Json& run, const Json& oracles) {
  for (const char* share : {"n95", "n99"})
    for (const char* oracle : kOracles)
      run[fmt::format("ratio_{}{}", share, oracle == kOracles[0] ? "" : fmt::format("_{}", oracle))] =
          ratio(run.at(share), oracles.at(oracle).at(share));
  const Json& bound = oracles.at(kBound);
  run["ratio_n99_bound"] = bound.is_null() ? Json(nullptr) : ratio(run.at("n99"), bound.at("n99"));
  run["ratio_n99_best"] = bound.is_null() ? Json(nullptr) : ratio(run.at("n99"), bound.at("best"));
}

template <int Dim>
Json score(const std::filesystem::path& folder, const World& world, const std::string& truth, const AuditPlan& plan, AuditProgress& progress) {
  const auto log = ScanLog<Dim>::open_to_read(folder / run_file::kScanLog);
  require(log.size() > 0, "the run has no scan", folder.string());
  progress.expect(1 + static_cast<std::int64_t>(plan.variants.size()));
  progress.begin("the truth");
  const TrialOptions options = options_of(world.scenario, log.size());
  const Trial<Dim> trial(true_scene<Dim>(world, truth), options);
  const Walls<Dim> walls = trial.walls(plan.walls), surface = trial.walls(all_surface(plan.walls));
  const Vec<Dim> start = log.read(0).origin;
  const Json oracles = oracles_json(trial.sight_table(start, plan.oracle, &walls), bound_work(plan));

  progress.begin("the run");
  Playback<Dim> playback(log);
  RunScore<Dim> score = trial.run(playback, start, options, {.max_scans = log.size(), .observer = &progress});
  Json json{{"scene", trial.scene().name}};
  json.update(run_json(score, walls_seen<Dim>(surface, trial.truth(), score.places)));
  add_ratios(json, oracles);
  json["reference_m3"] = trial.reference().volume();
  json["surface_m2"] = surface.area;
  json["walls_m2"] = walls.area;
  json["oracles"] = oracles;
  json["baselines"] = Json::object();
  progress.done("scored");

  const std::int64_t cap = cap_of(oracles, plan.cap);
  for (const Variant& variant : plan.variants) {
    progress.begin(variant.name);
    const Scenario scenario = with_settings(world.scenario, variant.settings, world.scene);
    TrialOptions peer = options_of(scenario, cap);
    peer.information_gain = variant.information_gain;
    const RunScore<Dim> theirs = trial.run(start, peer, {.max_scans = cap, .coverage = 0.99, .observer = &progress});
    Json& baseline = json["baselines"][variant.name];
    baseline = run_json(theirs, walls_seen<Dim>(surface, trial.truth(), theirs.places));
    baseline["cap"] = cap;
    add_ratios(baseline, oracles);
    progress.done(fmt::format("{} scans", theirs.places.size()));
  }
  return json;
}

}  // namespace

Json audit_run(const std::filesystem::path& folder, const std::string& truth, const AuditPlan& plan, AuditProgress& progress) {
  const World world = make_world((folder / run_file::kScenario).string(), {});
  return std::visit([&]<int Dim>(const Scene<Dim>&) { return score<Dim>(folder, world, truth, plan, progress); }, world.scene);
}
