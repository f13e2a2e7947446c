// SPDX-License-Identifier: Apache-2.0
#include "audit_generated.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/io/atomic_file.h"

using namespace vantage;

namespace {

constexpr std::int64_t kBatch = 64;       // Played at a time.
constexpr std::int64_t kKeepEvery = 128;  // Scenes between two writings of the folder.
constexpr const char* kFile = "generated.json";

std::string name_of(SmallKind kind, int dim) { return fmt::format("{}-{}d", small_kinds()[static_cast<std::size_t>(kind)], dim); }

Json to_json(const SmallScene& scene, const Ending& e) {
  return {{"kind", name_of(scene.kind, scene.dim)},
          {"seed", scene.seed},
          {"good", e.good()},
          {"scans", e.scans},
          {"ended", e.ended},
          {"reason", e.reason},
          {"reason_true", e.reason_true},
          {"complete", e.complete},
          {"share", e.share},
          {"share_widely", e.widely},
          {"bounds", {e.low, e.high}},
          {"verdict_right", e.verdict_right},
          {"repeated", e.repeated},
          {"collisions", e.collisions},
          {"unsafe", e.unsafe},
          {"least_clearance_m", e.least_clearance == kInfinity ? Json(nullptr) : Json(e.least_clearance)},
          {"false_free", e.falsely_free},
          {"error", e.error}};
}

/// What a folder knows of scenes with the same numbers.
std::vector<Json> kept(const GeneratedPlan& plan, const Json& what) {
  const std::filesystem::path file = plan.folder / kFile;
  if (plan.folder.empty() || !std::filesystem::exists(file)) return {};
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  require(json.is_object() && json.contains("runs"), "is not a file of generated scenes", file.string());
  require(json.at("what") == what, "holds scenes of another seed, other kinds or options: take another folder", file.string());
  return json.at("runs").get<std::vector<Json>>();
}

struct Sums {
  std::int64_t runs = 0, ended = 0, wrong = 0, complete = 0, repeated = 0, collisions = 0, unsafe = 0, untrue = 0, errors = 0, failed = 0, scans = 0;
  double width = 0.0, least_clearance = kInfinity, false_free = 0.0, most_false_free = 0.0;
  void add(const Json& e) {
    const double free = e.at("false_free");
    ++runs;
    ended += e.at("ended").get<bool>();
    wrong += !e.at("verdict_right").get<bool>();
    complete += e.at("complete").get<bool>();
    repeated += e.at("repeated").get<std::int64_t>();
    collisions += e.at("collisions").get<std::int64_t>();
    unsafe += e.at("unsafe").get<std::int64_t>();
    untrue += !e.at("reason_true").get<bool>();
    errors += !e.at("error").get<std::string>().empty();
    failed += !e.at("good").get<bool>();
    scans += e.at("scans").get<std::int64_t>();
    width += e.at("bounds")[1].get<double>() - e.at("bounds")[0].get<double>();
    if (e.at("least_clearance_m").is_number()) least_clearance = std::min(least_clearance, e.at("least_clearance_m").get<double>());
    false_free += free > 0.0 ? 1.0 : 0.0;
    most_false_free = std::max(most_false_free, free);
  }
  [[nodiscard]] Json json() const {
    const auto mean = [&](double sum) { return runs > 0 ? sum / static_cast<double>(runs) : 0.0; };
    return {{"runs", runs},
            {"ended", ended},
            {"wrong_verdicts", wrong},
            {"complete", complete},
            {"repeated", repeated},
            {"collisions", collisions},
            {"unsafe", unsafe},
            {"untrue_reasons", untrue},
            {"errors", errors},
            {"failed", failed},
            {"mean_scans", mean(static_cast<double>(scans))},
            {"mean_width", mean(width)},
            {"least_clearance_m", least_clearance == kInfinity ? Json(nullptr) : Json(least_clearance)},
            {"runs_with_false_free", false_free},
            {"most_false_free", most_false_free}};
  }
};

Json summary(const std::vector<Json>& runs, const Json& what) {
  std::map<std::string, Sums> kinds;
  Sums all;
  Json failures = Json::array();
  for (const Json& run : runs) {
    kinds[run.at("kind")].add(run);
    all.add(run);
    if (!run.at("good").get<bool>()) failures.push_back(run);
  }
  Json json{{"what", what}, {"kinds", Json::object()}, {"all", all.json()}, {"failures", failures}};
  for (const auto& [name, sums] : kinds) json["kinds"][name] = sums.json();
  return json;
}

void keep(const GeneratedPlan& plan, Json json, const std::vector<Json>& runs) {
  if (plan.folder.empty()) return;
  json["runs"] = runs;
  std::filesystem::create_directories(plan.folder);
  write_file(plan.folder / kFile, as_text(json));
}

TrialOptions adjust_by(const std::vector<Setting>& settings, const TrialOptions& options) {
  Scenario scenario;
  scenario.explore = options.explore;
  scenario.sensor = options.lidar;
  for (const Setting& setting : settings) apply(scenario, setting);
  return {scenario.explore, scenario.sensor};
}

/// Passes the wish to stop on, from any thread.
class Quiet final : public Observer {
 public:
  [[nodiscard]] bool stop_requested() override { return StopSignals::raised(); }
};

}  // namespace

SmallScene GeneratedPlan::scene(std::int64_t number) const {
  const auto count_of_kinds = static_cast<std::int64_t>(kinds.size());
  const auto& [kind, dim] = kinds[static_cast<std::size_t>(number % count_of_kinds)];
  return {kind, dim, static_cast<std::uint64_t>(seed + number / count_of_kinds)};
}

std::vector<std::pair<SmallKind, int>> kinds_of(const std::string& list) {
  std::vector<std::pair<SmallKind, int>> all, chosen;
  for (std::size_t k = 0; k < small_kinds().size(); ++k)
    for (const int dim : {2, 3}) all.emplace_back(static_cast<SmallKind>(k), dim);
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    const std::size_t before = chosen.size();
    for (const auto& [kind, dim] : all)
      if (name == name_of(kind, dim) || name == small_kinds()[static_cast<std::size_t>(kind)]) chosen.emplace_back(kind, dim);
    require(chosen.size() > before, fmt::format("{}: must be {}, each with -2d, -3d or neither", name, fmt::join(small_kinds(), ", ")), "--kinds");
    begin = end + 1;
  }
  return list.empty() ? all : chosen;
}

GeneratedOutcome play_generated(const GeneratedPlan& plan, AuditProgress& progress, const std::function<void(const Json&)>& each) {
  Json what{{"seed", plan.seed}, {"kinds", Json::array()}};
  for (const auto& [kind, dim] : plan.kinds) what["kinds"].push_back(name_of(kind, dim));
  for (const Setting& setting : plan.settings) what["set"].push_back(setting.name + "=" + setting.value);
  adjust_by(plan.settings, TrialOptions{});  // Wrong names are found before anything is played.
  std::vector<Json> runs = kept(plan, what);
  runs.resize(std::min(runs.size(), static_cast<std::size_t>(plan.count)));
  progress.expect(plan.count);
  for (const Json& run : runs) {
    progress.found();
    each(run);
  }
  std::int64_t unkept = 0;
  while (static_cast<std::int64_t>(runs.size()) < plan.count && !StopSignals::raised()) {
    const auto first = static_cast<std::int64_t>(runs.size()), count = std::min(kBatch, plan.count - first);
    progress.begin(name_of(plan.scene(first).kind, plan.scene(first).dim));
    std::vector<Json> batch(static_cast<std::size_t>(count));
    try {
      parallel_for(batch.size(), 1, [&](std::size_t k) {
        Quiet quiet;
        const SmallScene scene = plan.scene(first + static_cast<std::int64_t>(k));
        batch[k] = to_json(scene, play_to_end(scene, [&](TrialOptions& options) { options = adjust_by(plan.settings, options); }, &quiet));
      });
    } catch (const Error& error) {
      if (error.code() != ErrorCode::interrupted) throw;
      break;
    }
    for (const Json& run : batch) {
      progress.played();
      each(run);
      runs.push_back(run);
    }
    unkept += count;
    if (unkept < kKeepEvery) continue;
    keep(plan, summary(runs, what), runs);
    unkept = 0;
  }
  GeneratedOutcome outcome{summary(runs, what), static_cast<std::int64_t>(runs.size()) == plan.count};
  keep(plan, outcome.json, runs);
  return outcome;
}

std::string ending_text(const Json& e) {
  std::string wrong;
  const auto note = [&](bool bad, const std::string& text) {
    if (bad) wrong += (wrong.empty() ? "" : ", ") + text;
  };
  note(!e.at("error").get<std::string>().empty(), e.at("error"));
  note(!e.at("ended").get<bool>(), "did not end");
  note(!e.at("reason_true").get<bool>(), "reason not true");
  note(!e.at("verdict_right").get<bool>(), "verdict wrong");
  for (const char* key : {"repeated", "collisions", "unsafe"}) note(e.at(key) != 0, fmt::format("{} {}", e.at(key).get<int>(), key));
  note(wrong.empty(), "ok");
  return fmt::format("{:<13} seed {:<6} {:>3} scans  {:.4f} seen, said {} [{:.4f}, {:.4f}]  {}: {}\n", e.at("kind").get<std::string>(),
                     e.at("seed").get<std::int64_t>(), e.at("scans").get<int>(), e.at("share").get<double>(),
                     e.at("complete").get<bool>() ? "complete" : "not complete", e.at("bounds")[0].get<double>(), e.at("bounds")[1].get<double>(),
                     wrong, e.at("reason").get<std::string>());
}

std::string generated_text(const Json& json) {
  std::string out = fmt::format("{:<14} {:>6} {:>6} {:>6} {:>9} {:>9} {:>11} {:>7} {:>6} {:>6} {:>7} {:>9}\n", "", "runs", "ended", "wrong",
                                "complete", "repeated", "collisions", "unsafe", "untrue", "error", "scans", "width");
  const auto line = [&](const std::string& name, const Json& s) {
    out += fmt::format("{:<14} {:>6} {:>6} {:>6} {:>9} {:>9} {:>11} {:>7} {:>6} {:>6} {:>7.1f} {:>9.4f}\n", name, s.at("runs").get<int>(),
                       s.at("ended").get<int>(), s.at("wrong_verdicts").get<int>(), s.at("complete").get<int>(), s.at("repeated").get<int>(),
                       s.at("collisions").get<int>(), s.at("unsafe").get<int>(), s.at("untrue_reasons").get<int>(), s.at("errors").get<int>(),
                       s.at("mean_scans").get<double>(), s.at("mean_width").get<double>());
  };
  for (const auto& [name, sums] : json.at("kinds").items()) line(name, sums);
  line("all", json.at("all"));
  std::string options;
  for (const Json& set : json.at("what").value("set", Json::array())) options += " --set " + set.get<std::string>();
  for (const Json& failure : json.at("failures"))
    out += fmt::format("vantage audit --generated 1 --kinds {} --seed {}{} -v\n", failure.at("kind").get<std::string>(),
                       failure.at("seed").get<std::int64_t>(), options);
  return out;
}
