// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <list>
#include <string>
#include <vector>

#include "arguments.h"
#include "vantage/session/scenario.h"

/// SCENE and the options that make a scenario: short flags, --set and --config. Their texts come from the one description of each option.
class ScenarioArguments {
 public:
  /// Adds a positional SCENE and the flags to `parser`, which must not outlive this. `scene_help` says what SCENE is for.
  explicit ScenarioArguments(CommandParser& parser);

  /// SCENE as given, or empty.
  [[nodiscard]] const std::string& scene() const { return scene_; }
  /// In order of force: --config, then --set, then the short flags. Throws bad_input, io.
  [[nodiscard]] std::vector<vantage::Setting> settings() const;

 private:
  /// A short flag and the options it sets.
  struct Flag {
    std::string name, value;
    std::vector<std::string> options;
    CLI::Option* option = nullptr;
  };
  void add(CommandParser& parser, const std::string& name, const std::string& type, std::vector<std::string> options, const std::string& group);

  std::string scene_, config_;
  std::vector<std::string> sets_;
  std::list<Flag> flags_;  ///< The parser points into them.
};

/// What SCENE may be, for the help of each command.
inline constexpr const char* kSceneHelp =
    "built-in scene (vantage scene --list), with parameters as pipes:cylinders=12; a scenario .toml; mesh files joined by + "
    "(OBJ, PLY, STL, DAE, glTF, GLB, CityJSON, CityGML); or a 2D map (.yaml of ROS)";
