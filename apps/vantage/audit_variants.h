// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/session/scenario.h"

/// A way to explore: planner options behind a name.
struct Variant {
  std::string name, what;
  std::vector<vantage::Setting> settings;
  bool information_gain = false;  ///< The next place is chosen by an OctoMap (vantage/audit/information_gain.h).
};

/// The default and the baselines; one more is a line of this table.
[[nodiscard]] const std::vector<Variant>& built_in_variants();

/// The built-in ones named in `names` (between commas; `all`: every one this build can play; `none`), then those of `own`, each
/// NAME=stage.option=value,stage.option=value. Throws bad_input for unknown or repeated names, one this build cannot
/// play, wrong options, and options that would change what the
/// runs are compared with.
[[nodiscard]] std::vector<Variant> chosen_variants(const std::string& names, const std::vector<std::string>& own);
