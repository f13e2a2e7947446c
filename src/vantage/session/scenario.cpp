// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/session/scenario_file.h"
#include "vantage/session/suggest.h"

namespace vantage {
namespace {

void describe(SceneFileOptions& options, const OptionVisitor& visit) {
  visit("up", options.up, {"file", "y", "z"}, "up axis of a mesh file; file: what the file says, else z");
  visit("unit", options.unit, "m", Range{0.0, 1e6}, "metres per unit of a mesh file; 0: what the file says, else 1");
  visit("detail", options.detail, "", Range{-1.0, 100.0},
        "of a city model (CityJSON, CityGML) each object at its highest level of detail not above this, else its lowest; -1: its highest");
  visit("ground", options.ground, "m", Range{-kInfinity, 1e7}, "height of level ground that is added to mesh files which have none; -inf: none");
}

std::vector<Option> file_options(SceneFileOptions& options) {
  std::vector<Option> all;
  describe(options, OptionVisitor([&all](Option&& option) { all.push_back(std::move(option)); }));
  return all;
}

void append(std::vector<Option>& all, std::string_view stage, std::vector<Option> options) {
  for (Option& option : options) {
    option.name = fmt::format("{}.{}", stage, option.name);
    all.push_back(std::move(option));
  }
}

std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::vector<double> parse_numbers(const Setting& setting) {
  std::vector<double> numbers;
  if (setting.value.empty()) return numbers;
  double scratch = 0.0;
  for (const std::string& part : parts_of(setting.value, ',')) {
    Option option{"number", &scratch, "", {}, ""};
    option.parse(part, setting.name);
    require(std::isfinite(scratch), fmt::format("{} = {}: must be finite", setting.name, setting.value));
    numbers.push_back(scratch);
  }
  return numbers;
}

std::vector<double> parse_start(const Setting& setting) {
  std::vector<double> start = parse_numbers(setting);
  require(start.size() == 2 || start.size() == 3, fmt::format("{} = {}: must be x,y,z [m] (2D: x,y)", setting.name, setting.value));
  return start;
}

void apply_unplaced(Scenario& scenario, const Setting& setting) {
  if (setting.name == "scene.name") {
    require(!setting.value.empty(), "scene.name is empty");
    scenario.scene = setting.value;
    return;
  }
  if (setting.name == "scene.start") {
    scenario.start = parse_start(setting);
    return;
  }
  if (setting.name == "planner.weights") {
    scenario.explore.planner.weights = parse_numbers(setting);
    return;
  }
  std::vector<std::string> names{"scene.name", "scene.start", "planner.weights"};
  for (Option& option : list_options(scenario)) {
    names.push_back(option.name);
    if (option.name != setting.name) continue;
    if (option.name == "explore.voxel") scenario.grid = 0;  // The later of the two ways to say it counts.
    return option.parse(setting.value, setting.name);
  }
  require(false, fmt::format("{}: no such option{}", setting.name, did_you_mean(setting.name, names)));
}

/// A built-in name is never a file, whatever lies about in the folder.
bool names_file(const std::string& spec) {
  const std::string name = spec.substr(0, spec.find(':'));
  const auto& built_in = scene_list();
  if (std::any_of(built_in.begin(), built_in.end(), [&](const SceneInfo& info) { return info.name == name; })) return false;
  return std::filesystem::is_regular_file(spec) || spec.find('/') != std::string::npos;
}

/// File names made absolute, so that a run can be resumed from anywhere.
std::string settled(const std::string& spec) {
  std::vector<std::string> parts = parts_of(spec, '+');
  for (std::string& part : parts)
    if (names_file(part)) part = std::filesystem::absolute(part).lexically_normal().string();
  return fmt::format("{}", fmt::join(parts, "+"));
}

/// What the scene wishes, before anybody else says anything.
template <int Dim>
void take_defaults(Scenario& scenario, const Scene<Dim>& scene) {
  scenario.explore.voxel = scene.voxel;
  scenario.explore.surface.eta = scene.eta;
  scenario.explore.planner.clearance = scene.clearance;
  scenario.sensor.pattern.max_range = scene.range;
  scenario.start.assign(scene.start.data(), scene.start.data() + Dim);
}

template <int Dim>
void settle(Scenario& scenario, const Scene<Dim>& scene) {
  if (scenario.grid > 0) scenario.explore.voxel = scene.domain.size().maxCoeff() / static_cast<double>(scenario.grid);
  scenario.grid = 0;
  require(scenario.start.size() == Dim, fmt::format("scene.start: {} numbers: {} has {} dimensions", scenario.start.size(), scene.name, Dim));
  // Through their text, so that a run and its resumption, which reads them from a file, have the same bits.
  for (Option& option : list_options(scenario)) option.parse(option.text(), option.name);
}

}  // namespace

Setting parse_setting(const std::string& text, const std::string& where) {
  const std::size_t equals = text.find('=');
  require(equals != std::string::npos && equals > 0, text + ": must be stage.option=value", where);
  return {text.substr(0, equals), text.substr(equals + 1), where};
}

std::vector<Option> list_options(Scenario& s) {
  std::vector<Option> all;
  append(all, "scene", file_options(s.file));
  append(all, "explore", list_options(s.explore));
  append(all, "explore", {Option{"grid", &s.grid, "cells", Range{0.0, 1e6}, "cells along the domain's longest side; 0: voxel counts"}});
  append(all, "sensor", list_options(s.sensor));
  append(all, "surface", list_options(s.explore.surface));
  append(all, "visibility", list_options(s.explore.visibility));
  append(all, "planner", list_options(s.explore.planner));
  return all;
}

void apply(Scenario& scenario, const Setting& setting) {
  try {
    apply_unplaced(scenario, setting);
  } catch (const Error& error) {
    throw Error(error.code(), error.what(), setting.where);
  }
}

std::vector<Setting> joined_settings(const std::string& spec, std::span<const Setting> settings) {
  std::vector<Setting> all(settings.begin(), settings.end());
  if (spec.ends_with(".toml")) {
    const std::vector<Setting> file = read_scenario(spec);
    all.insert(all.begin(), file.begin(), file.end());
  } else if (!spec.empty()) {
    all.push_back({"scene.name", spec, ""});
  }
  return all;
}

Scenario with_settings(Scenario base, std::span<const Setting> settings, const AnyScene& scene) {
  for (const Setting& setting : settings) apply(base, setting);
  base.scene = settled(base.scene);
  std::visit([&](const auto& s) { settle(base, s); }, scene);
  return base;
}

World make_world(const std::string& spec, std::span<const Setting> settings) {
  const std::vector<Setting> all = joined_settings(spec, settings);
  Scenario scratch;  // Wrong names and values are found before anything is loaded.
  for (const Setting& setting : all) apply(scratch, setting);
  require(!scratch.scene.empty(), "no scene is named", spec);
  World world{{}, make_scene(scratch.scene, scratch.file)};
  std::visit([&](const auto& scene) { take_defaults(world.scenario, scene); }, world.scene);
  world.scenario = with_settings(std::move(world.scenario), all, world.scene);
  return world;
}

std::vector<std::pair<std::string, std::string>> settings_table(Scenario scenario) {
  std::vector<std::pair<std::string, std::string>> table;
  for (const Option& option : list_options(scenario))
    if (option.name != "explore.grid") table.emplace_back(option.name, option.unit.empty() ? option.text() : option.text() + " " + option.unit);
  return table;
}

std::vector<std::string> differences(Scenario wanted, Scenario here) {
  std::vector<std::string> found;
  if (wanted.scene != here.scene) found.push_back(fmt::format("scene.name = {} (here {})", wanted.scene, here.scene));
  if (wanted.explore.planner.weights != here.explore.planner.weights)
    found.push_back(fmt::format("planner.weights = [{}] (here [{}])", fmt::join(wanted.explore.planner.weights, ","),
                                fmt::join(here.explore.planner.weights, ",")));
  if (wanted.start != here.start)
    found.push_back(fmt::format("scene.start = {} (here {})", fmt::join(wanted.start, ","), fmt::join(here.start, ",")));
  const std::vector<Option> left = list_options(wanted), right = list_options(here);
  for (std::size_t i = 0; i < left.size(); ++i)
    if (left[i].text() != right[i].text()) found.push_back(fmt::format("{} = {} (here {})", left[i].name, left[i].text(), right[i].text()));
  return found;
}

}  // namespace vantage
