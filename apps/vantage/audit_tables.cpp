// SPDX-License-Identifier: Apache-2.0
#include "audit_tables.h"

#include <algorithm>

#include "audit_measures.h"

using vantage::Json;
using vantage::Setting;

namespace {

std::vector<Json> of_variant(const std::vector<Json>& runs, const std::string& variant) {
  std::vector<Json> chosen;
  for (const Json& run : runs)
    if (run.at("variant") == variant) chosen.push_back(run);
  return chosen;
}

}  // namespace

Json plan_json(const AuditPlan& plan) {
  Json variants = Json::object(), settings = Json::object();
  for (const Variant& variant : plan.variants) {
    Json options = Json::object();
    for (const Setting& setting : variant.settings) options[setting.name] = setting.value;
    variants[variant.name] = {{"what", variant.what}, {"settings", options}};
  }
  for (const Setting& setting : plan.settings) settings[setting.name] = setting.value;
  return {{"scenes", plan.scenes},
          {"layouts", plan.layouts},
          {"starts", plan.starts},
          {"seed", plan.seed},
          {"scene_start", plan.scene_start},
          {"to_the_end", plan.to_the_end},
          {"cap", plan.cap},
          {"targets", plan.oracle.targets},
          {"candidates", plan.oracle.candidates},
          {"walls", plan.walls.places},
          {"bound", plan.bound},
          {"settings", settings},
          {"variants", variants}};
}

Json oracle_curves(const std::vector<Json>& starts) {
  Json json = Json::object();
  for (const char* oracle : kOracles) {
    std::vector<std::vector<double>> curves;
    for (const Json& start : starts) curves.push_back(start.at("oracles").at(oracle).at("coverage").get<std::vector<double>>());
    json[oracle] = mean_curve(curves);
  }
  return json;
}

Json variants_json(const AuditPlan& plan, const std::vector<Json>& runs) {
  Json json = Json::object();
  for (const Variant& variant : plan.variants)
    if (const std::vector<Json> chosen = of_variant(runs, variant.name); !chosen.empty()) json[variant.name] = sums_json(chosen);
  return json;
}

Json seconds_json(const AuditPlan& plan, const std::vector<Json>& seconds) {
  Json json = Json::object();
  for (const Variant& variant : plan.variants) {
    double sum = 0.0, cpu = 0.0, scans = 0.0, peak = 0.0;
    for (const Json& run : seconds) {
      if (run.value("variant", "") != variant.name) continue;
      sum += run.at("seconds").get<double>();
      cpu += run.value("cpu_seconds", 0.0);
      scans += run.at("scans").get<double>();
      peak = std::max(peak, run.value("peak_memory_mib", 0.0));
    }
    if (scans > 0.0)
      json[variant.name] = {
          {"seconds", sum}, {"cpu_seconds", cpu}, {"seconds_a_scan", sum / scans}, {"cpu_seconds_a_scan", cpu / scans}, {"peak_memory_mib", peak}};
  }
  return json;
}
