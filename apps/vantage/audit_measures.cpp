// SPDX-License-Identifier: Apache-2.0
#include "audit_measures.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/audit/fewest_scans.h"

using vantage::Json;
using vantage::OracleRun;
using vantage::RunScore;
using vantage::SightTable;

namespace {

struct Motion {
  const char* name;
  double speed, per_scan;  // [m/s], [s]
};
constexpr Motion kMotions[] = {{"walk", 1.0, 120.0}, {"drone", 2.0, 2.0}};
constexpr int kShares[] = {90, 95, 99};

Json number_or_null(const auto& value) { return value ? Json(*value) : Json(nullptr); }

std::string name_of(int share) { return fmt::format("n{}", share); }

template <int Dim>
Json oracle_json(const SightTable<Dim>& table, const OracleRun& run, bool walls) {
  Json json;
  for (const int share : kShares) json[name_of(share)] = number_or_null(walls ? run.scans_to_both(0.01 * share) : run.scans_to(0.01 * share));
  json["scans"] = run.places.size();
  json["coverage"] = run.coverage;
  json["walls"] = run.walls;
  Json places = Json::array();
  for (const std::size_t place : run.places) places.push_back(vantage::to_json<Dim>(table.candidates[place]));
  json["places"] = places;
  return json;
}

template <int Dim>
Json bound_json(const SightTable<Dim>& table, const OracleRun& greedy, std::int64_t work) {
  const auto fewest = work > 0 ? vantage::fewest_scans(table, greedy, 0.99, work) : std::nullopt;
  if (!fewest) return nullptr;
  Json places = Json::array();
  for (const std::size_t place : fewest->places) places.push_back(vantage::to_json<Dim>(table.candidates[place]));
  return {{"n99", fewest->at_least},
          {"relaxation", fewest->relaxation},
          {"best", fewest->places.size()},
          {"proven", fewest->proven()},
          {"places", places}};
}

/// Scans of an oracle to a share; all it takes if it never gets there.
std::int64_t oracle_scans(const Json& oracle, const std::string& name) {
  return oracle.at(oracle.at(name).is_null() ? "scans" : name).get<std::int64_t>();
}

/// Scans of a run to a share; its cap if it never gets there.
std::int64_t run_scans(const Json& run, const std::string& name) { return run.at(run.at(name).is_null() ? "cap" : name).get<std::int64_t>(); }

double ratio(std::int64_t ours, std::int64_t theirs) { return static_cast<double>(ours) / static_cast<double>(std::max<std::int64_t>(theirs, 1)); }

/// Ratios to the bound and to the smallest choice known; null unless all starts have one.
void add_bounds(Json& sums, const std::vector<Json>& runs) {
  sums["oracles"][kBound] = sums["ratio_n99_bound"] = sums["ratio_n99_best"] = nullptr;
  std::int64_t ours = 0, least = 0, best = 0, proven = 0;
  for (const Json& run : runs) {
    const Json& bound = run.at("oracles").at(kBound);
    if (bound.is_null()) return;
    ours += run_scans(run, "n99");
    least += bound.at("n99").get<std::int64_t>();
    best += bound.at("best").get<std::int64_t>();
    proven += bound.at("proven") == Json(true) ? 1 : 0;
  }
  const auto each = [&](std::int64_t sum) { return static_cast<double>(sum) / static_cast<double>(runs.size()); };
  sums["oracles"][kBound] = {{"n99", each(least)}, {"best", each(best)}, {"proven", proven}};
  sums["ratio_n99_bound"] = ratio(ours, least);
  sums["ratio_n99_best"] = ratio(ours, best);
}

/// Mean of a number of the runs, of those that have it; null if none has.
Json mean(const std::vector<Json>& runs, const Json::json_pointer& where) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Json& run : runs) {
    const Json value = run.value(where, Json(nullptr));
    if (!value.is_number()) continue;
    sum += value.get<double>();
    ++count;
  }
  return count > 0 ? Json(sum / static_cast<double>(count)) : Json(nullptr);
}

Json most(const std::vector<Json>& runs, const char* name) {
  double most = 0.0;
  for (const Json& run : runs) most = std::max(most, run.at(name).get<double>());
  return most;
}

}  // namespace

template <int Dim>
Json oracles_json(const SightTable<Dim>& table, std::int64_t work) {
  const OracleRun anywhere = greedy_oracle(table);
  return {{kOracles[0], oracle_json(table, anywhere, false)},
          {kOracles[1], oracle_json(table, greedy_oracle(table, {.from_seen = true}), false)},
          {kOracles[2], oracle_json(table, greedy_oracle(table, {.walls = true}), true)},
          {kBound, bound_json(table, anywhere, work)}};
}

Json scans_of(const Json& oracles) {
  Json json;
  for (const char* oracle : kOracles) {
    for (const int share : kShares) json[oracle][name_of(share)] = oracles.at(oracle).at(name_of(share));
    json[oracle]["scans"] = oracles.at(oracle).at("scans");
  }
  json[kBound] = oracles.at(kBound);
  if (json[kBound].is_object()) json[kBound].erase("places");
  return json;
}

std::int64_t cap_of(const Json& oracles, double factor) {
  const std::int64_t best = oracle_scans(oracles.at(kOracles[0]), "n99");
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(factor * static_cast<double>(best)));
}

template <int Dim>
Json run_json(const RunScore<Dim>& score, const std::vector<double>& walls) {
  Json json;
  for (const int share : kShares) json[name_of(share)] = number_or_null(score.scans_to(0.01 * share));
  const std::size_t scans = score.coverage.size();
  const auto end = static_cast<std::size_t>(score.scans_to(0.99).value_or(static_cast<std::int64_t>(scans)));  // What is up to 99 %.
  json["scans"] = scans;
  json["picks"] = end > 0 ? end - 1 : 0;
  json["idle"] = vantage::idle_picks(score.coverage);
  const double path = end > 0 ? score.path[end - 1] : 0.0;
  json["path_m"] = path;
  for (const Motion& motion : kMotions) json["time_s"][motion.name] = path / motion.speed + motion.per_scan * static_cast<double>(end);
  json["false_free_m3"] = score.last.falsely_free;
  json["false_hidden_m3"] = score.falsely_hidden;
  json["surface_share"] = walls.empty() ? Json(nullptr) : Json(walls.back());
  json["thin_recall"] = number_or_null(score.thin_recall);
  json["verdict"] = {{"finished", score.finished},
                     {"complete", score.verdict.complete},
                     {"right", score.finished ? Json(score.verdict_right) : Json(nullptr)},
                     {"reason", score.verdict.reason},
                     {"seen_fraction", score.verdict.seen_fraction},
                     {"seen_fraction_bounds", {score.verdict.seen_low, score.verdict.seen_high}},
                     {"true_fraction", score.last.fraction},
                     {"true_fraction_widely", score.last.widely}};
  json["coverage"] = score.coverage;
  json["surface"] = walls;
  json["way_m"] = score.path;
  Json places = Json::array();
  for (const auto& place : score.places) places.push_back(vantage::to_json<Dim>(place));
  json["places"] = places;
  return json;
}

Json sums_json(const std::vector<Json>& runs) {
  Json json{{"runs", runs.size()}, {"missed", 0}};
  std::int64_t missed = 0, idle = 0, picks = 0, judged = 0, right = 0;
  std::int64_t useful = 0, wasted = 0, lost = 0;  // Scans of runs that get there: with gain and without; of the others.
  double worst = 0.0;
  for (const Json& run : runs) {
    missed += run.at("n99").is_null() ? 1 : 0;
    const bool there = !run.at("n99").is_null();
    useful += there ? run_scans(run, "n99") - run.at("idle").get<std::int64_t>() : 0;
    wasted += there ? run.at("idle").get<std::int64_t>() : 0;
    lost += there ? 0 : run_scans(run, "n99");
    idle += run.at("idle").get<std::int64_t>();
    picks += run.at("picks").get<std::int64_t>();
    const Json& verdict = run.at("verdict").at("right");
    judged += verdict.is_null() ? 0 : 1;
    right += verdict == Json(true) ? 1 : 0;
    worst = std::max(worst, ratio(run_scans(run, "n99"), oracle_scans(run.at("oracles").at(kOracles[0]), "n99")));
  }
  json["missed"] = missed;
  for (const int share : kShares) {
    const std::string name = name_of(share);
    std::int64_t ours = 0;
    for (const Json& run : runs) ours += run_scans(run, name);
    json[name] = static_cast<double>(ours) / static_cast<double>(runs.size());
    for (const char* oracle : kOracles) {
      std::int64_t theirs = 0;
      for (const Json& run : runs) theirs += oracle_scans(run.at("oracles").at(oracle), name);
      json["oracles"][oracle][name] = static_cast<double>(theirs) / static_cast<double>(runs.size());
      json["ratio_" + name + (oracle == kOracles[0] ? "" : fmt::format("_{}", oracle))] = ratio(ours, theirs);
    }
  }
  add_bounds(json, runs);
  json["worst_n99"] = worst;
  json["picks"] = picks;
  json["idle"] = idle;
  const auto each = [&](std::int64_t sum) { return static_cast<double>(sum) / static_cast<double>(runs.size()); };
  json["scans_a_run"] = {{"useful", each(useful)}, {"idle", each(wasted)}, {"missed", each(lost)}};
  json["idle_share"] = static_cast<double>(idle) / static_cast<double>(std::max<std::int64_t>(picks, 1));
  for (const char* name : {"path_m", "surface_share", "thin_recall", "false_free_m3", "false_hidden_m3"})
    json[name] = mean(runs, Json::json_pointer(fmt::format("/{}", name)));
  for (const Motion& motion : kMotions) json["time_s"][motion.name] = mean(runs, Json::json_pointer(fmt::format("/time_s/{}", motion.name)));
  json["most_false_free_m3"] = most(runs, "false_free_m3");
  json["verdicts"] = {{"judged", judged}, {"right", right}};
  std::vector<std::vector<double>> curves;
  for (const Json& run : runs) curves.push_back(run.at("coverage").get<std::vector<double>>());
  json["coverage"] = mean_curve(curves);
  return json;
}

std::vector<double> mean_curve(const std::vector<std::vector<double>>& curves) {
  std::vector<double> mean;
  for (const std::vector<double>& curve : curves) mean.resize(std::max(mean.size(), curve.size()));
  for (std::size_t k = 0; k < mean.size(); ++k) {
    for (const std::vector<double>& curve : curves) mean[k] += curve.empty() ? 0.0 : curve[std::min(k, curve.size() - 1)];
    mean[k] /= static_cast<double>(curves.size());
  }
  return mean;
}

template Json oracles_json<2>(const SightTable<2>&, std::int64_t);
template Json oracles_json<3>(const SightTable<3>&, std::int64_t);
template Json run_json<2>(const RunScore<2>&, const std::vector<double>&);
template Json run_json<3>(const RunScore<3>&, const std::vector<double>&);
