// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "vantage/audit/trial.h"
#include "vantage/session/result.h"

/// The oracles of a start, by the names under which they stand in the results.
inline constexpr const char* kOracles[] = {"anywhere", "seen", "walls"};
/// Beside them stands how few scans could do at best.
inline constexpr const char* kBound = "bound";

/// `{"n90", "n95", "n99", "scans", "coverage", "walls", "places"}` of each oracle; the one that must see the walls counts both shares. And the bound,
/// by about `work` elementary steps (fewest_scans.h): `{"n99", "relaxation", "best", "proven", "places"}`, null without work or where the first
/// oracle never gets there.
template <int Dim>
[[nodiscard]] vantage::Json oracles_json(const vantage::SightTable<Dim>& table, std::int64_t work);

/// The numbers of scans alone.
[[nodiscard]] vantage::Json scans_of(const vantage::Json& oracles);

/// How long a run may take: `factor` times the first oracle's scans to 99 %.
[[nodiscard]] std::int64_t cap_of(const vantage::Json& oracles, double factor);

/// All measures of one run: scans to 90, 95 and 99 % (null: never), idle picks, coverage, share of the walls, way, time, volumes, verdict.
/// `walls` is the share after each scan.
template <int Dim>
[[nodiscard]] vantage::Json run_json(const vantage::RunScore<Dim>& score, const std::vector<double>& walls);

/// Sums and means over runs (ratios to the bound null unless every start has one), each with `cap` and the `oracles` of its start: ratio = sum over
/// sum, a run that never gets there counts as its cap.
[[nodiscard]] vantage::Json sums_json(const std::vector<vantage::Json>& runs);

/// Mean of the curves; one that has ended stays where it is.
[[nodiscard]] std::vector<double> mean_curve(const std::vector<std::vector<double>>& curves);
