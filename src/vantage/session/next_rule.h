// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/planner/planner.h"
#include "vantage/session/next_options.h"

namespace vantage {

/// Where a scanner may be put by these options, and what counts more. `measured`: the scans are a person's. What had to be assumed is added to
/// `notes`, which must outlive the rule. Throws bad_input.
template <int Dim>
[[nodiscard]] StationRule<Dim> station_rule(const NextOptions& options, double clearance, bool measured, std::vector<std::string>& notes);

}  // namespace vantage
