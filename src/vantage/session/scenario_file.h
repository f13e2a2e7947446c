// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/session/scenario.h"

namespace vantage {

/// Settings of a TOML file with tables named like the stages, in the order of the file:
///
///     [scene]
///     name = "pipes:cylinders=12"
///     start = [0.0, 0.0, 1.5]
///     [surface]
///     eta = 0.05
///
/// Names of mesh files are relative to the file's folder. Throws io, or bad_input naming `FILE:LINE`. Names of options are not checked here.
[[nodiscard]] std::vector<Setting> read_scenario(const std::filesystem::path& path);
/// The same from memory; files beside `path` may be meant.
[[nodiscard]] std::vector<Setting> parse_scenario(std::string_view text, const std::filesystem::path& path);

/// The effective options as such a file. With `documented` each has a comment with unit, range and meaning above it.
[[nodiscard]] std::string scenario_as_toml(Scenario scenario, bool documented);

}  // namespace vantage
