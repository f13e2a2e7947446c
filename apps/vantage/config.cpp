// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "arguments.h"
#include "commands.h"
#include "scenario_arguments.h"
#include "vantage/base/error.h"
#include "vantage/session/scenario_file.h"

namespace {

constexpr const char* kPurpose =
    "Prints every option as a scenario file, with unit, range and meaning: the values that explore would use with the same arguments.\n"
    "Without SCENE, the defaults that hold for all scenes (each scene brings its own lattice, eta, range, clearance and start).\n";

constexpr const char* kExamples =
    "  vantage config dump\n"
    "  vantage config dump town --eta 0.05 > mine.toml && vantage explore mine.toml";

}  // namespace

int config_command(const Arguments& arguments) {
  CommandParser parser("config", "dump [SCENE] [options]", kPurpose, kExamples);
  std::string action;
  parser.app().add_option("ACTION", action, "dump");
  ScenarioArguments scenario(parser);
  if (!parser.parse(arguments)) return 0;
  vantage::require(action == "dump", action.empty() ? "ACTION is missing: vantage config dump" : fmt::format("{}: must be dump", action));
  vantage::Scenario effective;
  if (scenario.scene().empty()) {
    for (const vantage::Setting& setting : scenario.settings()) apply(effective, setting);
  } else {
    effective = make_world(scenario.scene(), scenario.settings()).scenario;
  }
  fmt::print("{}", scenario_as_toml(effective, true));
  return 0;
}
