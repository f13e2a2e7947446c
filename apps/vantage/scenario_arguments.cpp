// SPDX-License-Identifier: Apache-2.0
#include "scenario_arguments.h"

#include <fmt/format.h>

#include "vantage/base/error.h"
#include "vantage/session/scenario_file.h"

using vantage::Option;
using vantage::Scenario;
using vantage::Setting;

namespace {

/// "Hausdorff tolerance of a fit (1e-09 .. 10 [m])", from the option's own description.
std::string help_of(const std::string& name) {
  Scenario scenario;
  for (const Option& option : list_options(scenario))
    if (option.name == name) return fmt::format("{} ({}; {})", option.doc, option.allowed(), option.name);
  if (name == "planner.weights")
    return "how much seeing a place is worth: a box and its weight, 1 elsewhere; several boxes one after the other (planner.weights)";
  return "first vantage point, inside the domain [m] (2D: x,y)";
}

}  // namespace

ScenarioArguments::ScenarioArguments(CommandParser& parser) {
  const std::string scene = "Scene", sensor = "Sensor", method = "Method";
  parser.app().add_option("SCENE", scene_, kSceneHelp);
  add(parser, "--start", "x,y,z", {"scene.start"}, scene);
  add(parser, "--up", "AXIS", {"scene.up"}, scene);
  add(parser, "--unit", "METRES", {"scene.unit"}, scene);
  add(parser, "--ground", "Z", {"scene.ground"}, scene);
  add(parser, "--detail", "LEVEL", {"scene.detail"}, scene);
  add(parser, "--range", "METRES", {"sensor.range"}, sensor);
  add(parser, "--step-deg", "DEGREES", {"sensor.step_deg"}, sensor);
  add(parser, "--noise", "METRES", {"sensor.range_noise"}, sensor);
  add(parser, "--eta", "METRES", {"surface.eta"}, method);
  add(parser, "--voxel", "METRES", {"explore.voxel"}, method);
  add(parser, "--grid", "CELLS", {"explore.grid"}, method);
  add(parser, "--clearance", "METRES", {"planner.clearance"}, method);
  add(parser, "--weight", "x0,y0,z0,x1,y1,z1,w", {"planner.weights"}, method);
  add(parser, "--seed", "N", {"explore.seed", "sensor.seed"}, method);
  parser.app()
      .add_option("--set", sets_, "any option; vantage config dump lists all of them with unit, range and meaning")
      ->type_name("STAGE.OPTION=VALUE")
      ->group(method);
  parser.option("--config", config_, "FILE", "a scenario file with some or all options; what is given here wins over it", method);
}

void ScenarioArguments::add(CommandParser& parser, const std::string& name, const std::string& type, std::vector<std::string> options,
                            const std::string& group) {
  const std::string help = help_of(options.front());
  Flag& flag = flags_.emplace_back(Flag{name, "", std::move(options), nullptr});
  flag.option = parser.option(name, flag.value, type, help, group);
}

std::vector<Setting> ScenarioArguments::settings() const {
  std::vector<Setting> all;
  if (!config_.empty()) all = vantage::read_scenario(config_);
  for (const std::string& text : sets_) all.push_back(vantage::parse_setting(text, "--set"));
  for (const Flag& flag : flags_)
    if (flag.option->count() > 0)
      for (const std::string& option : flag.options) all.push_back({option, flag.value, flag.name});
  return all;
}
