// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "audit_campaign.h"

/// What was asked for, as it stands in audit.json.
[[nodiscard]] vantage::Json plan_json(const AuditPlan& plan);

/// Mean curve of each oracle over the starts.
[[nodiscard]] vantage::Json oracle_curves(const std::vector<vantage::Json>& starts);

/// Sums over the runs of each variant, as sums_json().
[[nodiscard]] vantage::Json variants_json(const AuditPlan& plan, const std::vector<vantage::Json>& runs);

/// Seconds, of the clock and of all threads, of each variant, in all and a scan, and the largest peak of the memory.
[[nodiscard]] vantage::Json seconds_json(const AuditPlan& plan, const std::vector<vantage::Json>& seconds);
