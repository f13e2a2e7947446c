// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "audit_progress.h"
#include "vantage/audit/ending.h"
#include "vantage/session/result.h"
#include "vantage/session/scenario.h"

/// Which small scenes are played to their ends.
struct GeneratedPlan {
  std::int64_t count = 500, seed = 1;
  std::vector<std::pair<vantage::SmallKind, int>> kinds;  ///< With their dimensions.
  std::filesystem::path folder;                           ///< Keeps what is finished; empty: nothing is kept.
  std::vector<vantage::Setting> settings;                 ///< Options of every run that are not as they stand.
  [[nodiscard]] vantage::SmallScene scene(std::int64_t number) const;
};

/// `rooms,maze-2d`: kinds in both dimensions or one; all where empty. Throws bad_input, naming the kinds.
[[nodiscard]] std::vector<std::pair<vantage::SmallKind, int>> kinds_of(const std::string& list);

struct GeneratedOutcome {
  vantage::Json json;  ///< Table by kind, sums, and every scene that failed.
  bool complete = false;
};

/// Plays them, several at a time, and checks every run (audit/ending.h). With a folder, scenes that are finished there are not played again.
/// `each` hears of every scene in its order. Stops when the progress asks to.
[[nodiscard]] GeneratedOutcome play_generated(const GeneratedPlan& plan, AuditProgress& progress,
                                              const std::function<void(const vantage::Json&)>& each);

/// The table, and how each failure is played again.
[[nodiscard]] std::string generated_text(const vantage::Json& json);
/// One scene in one line: what it came to, and what was wrong.
[[nodiscard]] std::string ending_text(const vantage::Json& ending);
