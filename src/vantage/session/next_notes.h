// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "vantage/session/measured.h"
#include "vantage/session/result.h"

namespace vantage {

/// A volume or area without more digits than are true: "0.0421", "8.59", "1231".
[[nodiscard]] std::string amount_text(double amount);

/// "1.00, 2.00, 1.50"
[[nodiscard]] std::string place_text(const Vec<3>& p);

/// One line on a scan that was read: points, place, what was left out.
[[nodiscard]] std::string input_line(const MeasuredInput& input);
/// The same for the manifest.
[[nodiscard]] Json input_json(const MeasuredInput& input);

/// What the directions without a hit were taken for.
[[nodiscard]] std::string no_return_note(std::span<const MeasuredInput> inputs, const MeasuredOptions& options);
/// What the filter took out, by which rule.
[[nodiscard]] std::string filter_note(std::span<const MeasuredInput> inputs, const FilterOptions& options);
/// How many points of all moved, found with `gap` [m].
[[nodiscard]] std::string moved_note(std::size_t moved, std::size_t points, double gap);

}  // namespace vantage
