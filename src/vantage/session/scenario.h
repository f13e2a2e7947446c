// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/explore/explore.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"

namespace vantage {

/// All that a run depends on: one file, `scenario.toml`, can hold it.
struct Scenario {
  std::string scene;          ///< Built-in name with parameters, mesh files joined by `+`, or a 2D map.
  SceneFileOptions file;      ///< How a mesh file is read.
  std::vector<double> start;  ///< First vantage point, Dim numbers [m].
  std::int64_t grid = 0;      ///< Cells along the domain's longest side; 0: explore.voxel counts.
  LidarOptions sensor;
  ExploreOptions explore;
};

/// An option's value as somebody wrote it.
struct Setting {
  std::string name;   ///< `surface.eta`
  std::string value;  ///< `0.05`
  std::string where;  ///< `--eta`, `town.toml:12`; for messages.
};

/// `surface.eta=0.05`, as written at `where`; throws bad_input.
[[nodiscard]] Setting parse_setting(const std::string& text, const std::string& where);

/// Every option as `stage.name`, stage by stage (scene, explore, sensor, surface, visibility, planner), pointing into `scenario`.
/// `scene.name` and `scene.start`, which are no numbers, are not among them.
[[nodiscard]] std::vector<Option> list_options(Scenario& scenario);

/// Sets one option; throws bad_input naming the place, what is allowed, and for an unknown name the nearest one.
void apply(Scenario& scenario, const Setting& setting);

/// A scenario with its world, ready to run.
struct World {
  Scenario scenario;
  AnyScene scene;
};

/// Loads the scene that `spec` (or else a setting of scene.name) names; `spec` may be a scenario file, whose settings come first. The scene's own
/// lattice, eta, range, clearance and start are the defaults; `settings` are applied in order on top. Throws bad_input, io, memory.
[[nodiscard]] World make_world(const std::string& spec, std::span<const Setting> settings);

/// The settings of a scenario file that `spec` is, or of the scene it names, joined with `settings` in order of force.
[[nodiscard]] std::vector<Setting> joined_settings(const std::string& spec, std::span<const Setting> settings);

/// `base` with the settings applied, for a scene that is loaded already.
[[nodiscard]] Scenario with_settings(Scenario base, std::span<const Setting> settings, const AnyScene& scene);

/// `60` or `0.5 m` or `ray`: the value with its unit, for tables.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> settings_table(Scenario scenario);

/// Names of the options whose values differ, with both values: "surface.eta = 0.2 (here 0.1)".
[[nodiscard]] std::vector<std::string> differences(Scenario wanted, Scenario here);

}  // namespace vantage
