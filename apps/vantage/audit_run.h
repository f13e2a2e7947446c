// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "audit_campaign.h"

/// A finished run folder, played again from its scan log and scored by the truth: its own scene, or the mesh, built-in or scenario that `truth`
/// names. Oracles and the plan's variants begin where its first scan was taken. `{"ratio_n95", "ratio_n99", "oracles", "baselines", "coverage",
/// "false_free_m3", "thin_recall", …}`. Throws bad_input, io, interrupted.
[[nodiscard]] vantage::Json audit_run(const std::filesystem::path& folder, const std::string& truth, const AuditPlan& plan, AuditProgress& progress);
