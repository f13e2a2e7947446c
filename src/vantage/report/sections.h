// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "vantage/report/report.h"

namespace vantage {

/// Scene, verdict in words, and the key figures.
template <int Dim>
[[nodiscard]] std::string header_html(const ReportInput<Dim>& input);
/// Curves over the scans: seen share, new volume, max E, way.
template <int Dim>
[[nodiscard]] std::string curves_html(const ReportInput<Dim>& input);
/// The places to scan from next and what was assumed; nothing if the input has neither.
template <int Dim>
[[nodiscard]] std::string next_html(const ReportInput<Dim>& input);
/// What stays unseen, the steps, the settings and the command.
template <int Dim>
[[nodiscard]] std::string tables_html(const ReportInput<Dim>& input);

/// The verdict in one or two plain sentences.
template <int Dim>
[[nodiscard]] std::string verdict_text(const ReportInput<Dim>& input);

}  // namespace vantage
