// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vantage/explore/record.h"
#include "vantage/surface/surface.h"

namespace vantage {

using Json = nlohmann::ordered_json;

/// `{"complete", "reason", "seen_fraction", "seen_fraction_bounds", "unseen": [{"volume_m3", "box", "reason", "open_from"}]}`; `open_from` is a place
/// or null. Numbers that are not finite become null.
template <int Dim>
[[nodiscard]] Json to_json(const Verdict<Dim>& verdict);

/// One step of `result.json`: only what does not depend on the machine.
template <int Dim>
[[nodiscard]] Json to_json(const StepRecord<Dim>& step);

/// The `surface` object of `result.json`, by the names of the paper's Table I.
[[nodiscard]] Json to_json(const SurfaceStatistics& surface);

template <int Dim>
[[nodiscard]] Json to_json(const Vec<Dim>& p) {
  return Json(std::vector<double>(p.data(), p.data() + Dim));
}

/// `steps.csv`: the same as a table, one row a step.
template <int Dim>
[[nodiscard]] std::string steps_as_csv(const std::vector<StepRecord<Dim>>& steps);

/// Text as a file or a terminal gets it: two blanks a level, a line end at the end.
[[nodiscard]] std::string as_text(const Json& json);

}  // namespace vantage
