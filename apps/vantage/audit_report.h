// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "vantage/session/result.h"

/// `report.html` of an audit.json: curves of each scene, tables of ratios, what was wasted. One page without network.
[[nodiscard]] std::string audit_report(const vantage::Json& audit);

/// The table for the terminal; with `curves` place and share after every scan.
[[nodiscard]] std::string audit_text(const vantage::Json& audit, const vantage::Json& timing, bool curves);
/// The same of one scored run.
[[nodiscard]] std::string score_text(const vantage::Json& score, bool curves);
