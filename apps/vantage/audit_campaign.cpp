// SPDX-License-Identifier: Apache-2.0
#include "audit_campaign.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cctype>
#include <chrono>

#include "audit_measures.h"
#include "audit_memory.h"
#include "audit_tables.h"
#include "vantage/base/error.h"
#include "vantage/base/version.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/session/outputs.h"
#include "vantage/session/scenario_file.h"

using namespace vantage;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

namespace {

std::string slug(std::string text) {
  std::replace_if(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  return text.substr(text.size() > 60 ? text.size() - 60 : 0);
}

std::string crc(const Json& key) { return fmt::format("{:08x}", checksum(key.dump())); }

/// Writes a result, in a folder that is made when the first one is there.
void keep(const fs::path& path, const Json& json) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) throw Error(ErrorCode::io, "not a folder, and cannot be made one", path.parent_path().string());
  write_file(path, as_text(json));
}

void check_folder(const fs::path& folder) {
  require(!fs::exists(folder) || fs::is_directory(folder), "is a file", folder.string());
  const bool fits = !fs::exists(folder) || fs::is_empty(folder) || fs::exists(folder / "oracles");
  require(fits, "the folder is not empty, and not of an audit", folder.string());
}

/// A file of an earlier call; throws bad_input when it is none.
Json kept(const fs::path& path) {
  Json json = Json::parse(read_file(path), nullptr, false);
  require(json.is_object(), "not a result of an audit", path.string());
  return json;
}

/// Of this process, all threads [s].
double cpu_seconds() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string result_line(const Json& run) {
  const Json& n99 = run.at("n99");
  return fmt::format("{} scans, {}, oracle {}", run.at("scans").get<std::int64_t>(),
                     n99.is_null() ? std::string("99 % never reached") : fmt::format("99 % after {}", n99.get<std::int64_t>()),
                     run.at("oracles").at(kOracles[0]).at("n99").dump());
}

/// What the folder has of a scene.
struct AuditResults {
  std::vector<Json> starts;  ///< Oracles.
  std::vector<Json> runs, seconds;
};

/// One layout of a scene: its files, and what has to be known of it to play what is missing.
template <int Dim>
class Layout {
 public:
  Layout(const AuditPlan& plan, const std::string& spec, const World& world, AuditProgress& progress)
      : plan_(plan), spec_(spec), world_(world), scene_(std::get<Scene<Dim>>(world.scene)), progress_(progress) {
    const Json common{{"vantage", kVersion},
                      {"inputs", manifest_json<Dim>(world.scenario, scene_)["inputs"]},
                      {"seed", plan.seed},
                      {"scene_start", plan.scene_start},
                      {"targets", plan.oracle.targets},
                      {"candidates", plan.oracle.candidates},
                      {"walls", plan.walls.places},
                      {"bound", plan.bound},
                      {"options", scenario_as_toml(world.scenario, false)}};
    oracle_crc_ = crc(common);
    for (const Variant& variant : plan.variants) {
      scenarios_.push_back(with_settings(world.scenario, variant.settings, world.scene));
      Json key = common;
      key["options"] = scenario_as_toml(scenarios_.back(), false);
      key["cap"] = plan.cap;
      key["to_the_end"] = plan.to_the_end;
      if (variant.information_gain) key["information_gain"] = true;
      crcs_.push_back(crc(key));
    }
  }

  /// Adds the results of every start and variant, in this order, and the oracles of every start; ends early when stopped.
  void play(AuditResults& results) {
    for (std::int64_t start = 0; start < plan_.starts; ++start) {
      for (std::size_t v = 0; v < plan_.variants.size(); ++v) {
        if (progress_.stop_requested()) return;
        const fs::path file = plan_.folder / "runs" / name(start, plan_.variants[v].name, crcs_[v]);
        const fs::path timing = plan_.folder / "seconds" / file.filename();
        if (fs::exists(file))
          progress_.found();
        else if (!play(start, v, file, timing))
          return;
        if (v == 0) results.starts.push_back(oracles_at(start));
        results.runs.push_back(kept(file));
        if (fs::exists(timing)) results.seconds.push_back(kept(timing));
      }
    }
  }

 private:
  [[nodiscard]] std::string name(std::int64_t start, const std::string& what, const std::string& crc) const {
    return fmt::format("{}.{}.{}.{}.json", slug(spec_), start, what, crc);
  }

  /// False if it was stopped.
  bool play(std::int64_t start, std::size_t v, const fs::path& file, const fs::path& timing) {
    const std::string label = fmt::format("{} start {} {}", spec_, start, plan_.variants[v].name);
    progress_.begin(label + ": the truth");
    know();
    const Json oracles = oracles_at(start);
    progress_.begin(label);
    const std::int64_t cap = cap_of(oracles.at("oracles"), plan_.cap);
    const PeakMemory memory;
    const Clock::time_point begin = Clock::now();
    const double cpu_begin = cpu_seconds();
    RunScore<Dim> score;
    try {
      TrialOptions options = options_of(scenarios_[v]);
      options.information_gain = plan_.variants[v].information_gain;
      score = trial_->run(starts_[static_cast<std::size_t>(start)], options,
                          {.max_scans = cap, .coverage = 0.99, .to_the_end = plan_.to_the_end, .observer = &progress_});
    } catch (const Error& error) {
      if (error.code() == ErrorCode::interrupted) return false;
      throw;
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count(), cpu = cpu_seconds() - cpu_begin, peak = memory.peak();
    Json run{{"scene", spec_}, {"start", start}, {"variant", plan_.variants[v].name}, {"cap", cap}};
    run.update(run_json(score, walls_seen<Dim>(*surface_, trial_->truth(), score.places)));
    run["reference_m3"] = oracles.at("reference_m3");
    run["oracles"] = scans_of(oracles.at("oracles"));
    keep(timing, {{"scene", spec_},
                  {"start", start},
                  {"variant", plan_.variants[v].name},
                  {"scans", score.places.size()},
                  {"seconds", seconds},
                  {"cpu_seconds", cpu},
                  {"memory_before_mib", memory.before()},
                  {"peak_memory_mib", peak}});
    keep(file, run);
    progress_.done(result_line(run));
    return true;
  }

  static TrialOptions options_of(const Scenario& scenario) {
    TrialOptions options{scenario.explore, scenario.sensor, false};
    options.explore.snapshots = false;
    return options;
  }

  /// Where one can go and what there is to see.
  void know() {
    if (trial_) return;
    trial_.emplace(scene_, options_of(world_.scenario));
    walls_ = trial_->walls(plan_.walls);
    surface_ = trial_->walls(all_surface(plan_.walls));
    starts_ = trial_->starts(plan_.starts, plan_.seed);
    if (plan_.scene_start) starts_[0] = Eigen::Map<const Vec<Dim>>(world_.scenario.start.data());
  }

  /// The oracles of a start, kept for all variants.
  Json oracles_at(std::int64_t start) {
    const fs::path file = plan_.folder / "oracles" / name(start, "oracles", oracle_crc_);
    if (fs::exists(file)) return kept(file);
    progress_.begin(fmt::format("{} start {}: the oracles", spec_, start));
    know();
    const Vec<Dim>& place = starts_[static_cast<std::size_t>(start)];
    if (table_)
      move_start<Dim>(*table_, {trial_->reference(), trial_->truth(), &*walls_}, place);
    else
      table_ = trial_->sight_table(place, plan_.oracle, &*walls_);
    const Json json{{"scene", spec_},
                    {"start", start},
                    {"place", to_json<Dim>(place)},
                    {"reference_m3", trial_->reference().volume()},
                    {"surface_m2", surface_->area},
                    {"walls_m2", walls_->area},
                    {"targets", table_->targets},
                    {"walls", table_->walls},
                    {"candidates", table_->candidates.size()},
                    {"oracles", oracles_json(*table_, bound_work(plan_))}};
    keep(file, json);
    return json;
  }

  const AuditPlan& plan_;
  std::string spec_;
  const World& world_;
  const Scene<Dim>& scene_;
  AuditProgress& progress_;
  std::string oracle_crc_;
  std::vector<std::string> crcs_;    ///< A variant each.
  std::vector<Scenario> scenarios_;  ///< A variant each.
  std::optional<Trial<Dim>> trial_;
  std::optional<Walls<Dim>> walls_, surface_;
  std::optional<SightTable<Dim>> table_;
  std::vector<Vec<Dim>> starts_;
};

bool same_place(const AnyScene& one, const AnyScene& two) {
  return std::visit(
      [&]<int Dim>(const Scene<Dim>& scene) {
        const auto* other = std::get_if<Scene<Dim>>(&two);
        return other != nullptr && scene.mesh.vertices == other->mesh.vertices && scene.mesh.facets == other->mesh.facets;
      },
      one);
}

}  // namespace

std::vector<std::string> layouts_of(const std::string& scene, std::int64_t count) {
  const std::string name = scene.substr(0, scene.find(':'));
  const auto& known = scene_list();
  const auto info = std::find_if(known.begin(), known.end(), [&](const SceneInfo& s) { return s.name == name; });
  if (info == known.end() || scene.find("seed=") != std::string::npos) return {scene};
  const auto with_seed = [&](std::int64_t seed) { return fmt::format("{}{}seed={}", scene, scene == name ? ":" : ",", seed); };
  if (count > 1 && same_place(make_scene(with_seed(1)), make_scene(with_seed(2)))) return {scene};
  std::vector<std::string> layouts;
  for (std::int64_t seed = 1; seed <= count; ++seed) layouts.push_back(with_seed(seed));
  return layouts;
}

std::int64_t bound_work(const AuditPlan& plan) { return 1'000'000 * plan.bound; }

WallOptions all_surface(WallOptions options) {
  options.clutter = true;
  return options;
}

AuditOutcome play_audit(const AuditPlan& plan, AuditProgress& progress) {
  check_folder(plan.folder);
  std::vector<std::vector<std::string>> layouts;
  std::int64_t total = 0, found = 0;
  for (const std::string& scene : plan.scenes) {
    layouts.push_back(layouts_of(scene, plan.layouts));
    (void)make_world(layouts.back().front(), plan.settings);  // Wrong names are found before anything is written.
    total += static_cast<std::int64_t>(layouts.back().size() * plan.variants.size()) * plan.starts;
  }
  progress.expect(total);
  Json scenes = Json::array(), timing = Json::array();
  std::vector<Json> all;
  for (std::size_t s = 0; s < plan.scenes.size() && !progress.stop_requested(); ++s) {
    AuditResults results;
    for (const std::string& spec : layouts[s]) {
      if (progress.stop_requested()) break;
      const World world = make_world(spec, plan.settings);
      std::visit([&]<int Dim>(const Scene<Dim>&) { Layout<Dim>(plan, spec, world, progress).play(results); }, world.scene);
    }
    if (results.runs.empty()) continue;
    found += static_cast<std::int64_t>(results.runs.size());
    scenes.push_back({{"scene", plan.scenes[s]},
                      {"layouts", layouts[s]},
                      {"oracles", oracle_curves(results.starts)},
                      {"variants", variants_json(plan, results.runs)},
                      {"starts", results.starts},
                      {"runs", results.runs}});
    timing.push_back({{"scene", plan.scenes[s]}, {"variants", seconds_json(plan, results.seconds)}, {"runs", results.seconds}});
    all.insert(all.end(), results.runs.begin(), results.runs.end());
  }
  const Json audit{
      {"vantage", kVersion}, {"complete", found == total}, {"plan", plan_json(plan)}, {"all", variants_json(plan, all)}, {"scenes", scenes}};
  return {audit, {{"vantage", kVersion}, {"scenes", timing}}, found == total};
}
