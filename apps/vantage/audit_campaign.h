// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "audit_progress.h"
#include "audit_variants.h"
#include "vantage/audit/sight_table.h"
#include "vantage/session/result.h"

/// What is compared, and how.
struct AuditPlan {
  std::vector<std::string> scenes;  ///< As for make_world.
  std::vector<Variant> variants;
  std::vector<vantage::Setting> settings;  ///< Of every run.
  std::int64_t layouts = 1;                ///< Of each scene that is drawn from a seed.
  std::int64_t starts = 3;                 ///< In each layout.
  std::int64_t seed = 2026;                ///< Of the starts.
  bool scene_start = false;                ///< The first start is the scene's own.
  bool to_the_end = false;                 ///< Go on after 99 % until the explorer stops, to judge its verdict.
  double cap = 3.0;                        ///< Scans of a run up to 99 %, at most so many times those of the first oracle.
  vantage::OracleOptions oracle;
  vantage::WallOptions walls;
  std::int64_t bound = 3000;     ///< Million elementary steps for the lower bound of a start; 0: none.
  std::filesystem::path folder;  ///< Of the results.
};

/// The layouts of a scene: `blocks:seed=1`, `blocks:seed=2`, …; the scene alone if its seed is given or changes nothing.
[[nodiscard]] std::vector<std::string> layouts_of(const std::string& scene, std::int64_t count);

/// AuditPlan::bound in elementary steps.
[[nodiscard]] std::int64_t bound_work(const AuditPlan& plan);

/// For the share of all surface seen.
[[nodiscard]] vantage::WallOptions all_surface(vantage::WallOptions options);

struct AuditOutcome {
  vantage::Json audit;   ///< `audit.json`: the same bytes however often the audit was interrupted.
  vantage::Json timing;  ///< `timing.json`: seconds.
  bool complete = false;
};

/// Plays the runs that the folder does not have yet and puts all together. A run is kept as soon as it is finished; the observer may stop in
/// between. Throws bad_input, io, memory.
[[nodiscard]] AuditOutcome play_audit(const AuditPlan& plan, AuditProgress& progress);
