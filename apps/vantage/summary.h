// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "vantage/session/run.h"

/// What a person wants to know after a run; the last line names the report.
[[nodiscard]] std::string summary(const vantage::RunOutcome& outcome);

/// The command that goes on with a run.
[[nodiscard]] std::string resume_hint(const vantage::RunOutcome& outcome);

/// The `surface` object in words: "23,456 polygons … within 0.087 m".
[[nodiscard]] std::string surface_sentence(const vantage::Json& surface, int dim);

/// An exchanged map in words: "16 deltas of 1 source, 386,859 bytes: …".
[[nodiscard]] std::string map_sentence(const vantage::Json& map);

/// Any JSON object as lines `key  value`, for `vantage info`.
[[nodiscard]] std::string as_lines(const vantage::Json& json);
