// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "vantage/base/progress.h"
#include "vantage/explore/explore.h"
#include "vantage/report/report.h"
#include "vantage/session/result.h"
#include "vantage/session/scan_log.h"
#include "vantage/session/scenario.h"

namespace vantage {

/// What `vantage next` adds to a run of a person's scans.
template <int Dim>
struct NextFigures {
  std::vector<RankedPlace<Dim>> ranked;
  Verdict<Dim> verdict;
  NextPlan<Dim> plan;
  std::vector<std::string> notes;  ///< What was assumed.
  Json inputs;                     ///< Files of the scans, for the manifest.
};

/// What the outputs of a run are made from.
template <int Dim>
struct RunOutputs {
  const Scenario& scenario;
  const Scene<Dim>& scene;
  const Explorer<Dim>& explorer;
  const ScanLog<Dim>& log;
  const NextFigures<Dim>* next = nullptr;  ///< Of a person's scans; none: explored.
};

/// `result.json`.
template <int Dim>
[[nodiscard]] Json result_json(const RunOutputs<Dim>& run);

/// Version, seed, and name and checksum of the inputs: the scene's name and its facets as loaded. No dates.
template <int Dim>
[[nodiscard]] Json manifest_json(const Scenario& scenario, const Scene<Dim>& scene);

/// Writes every output of the run folder that is made from the scan log (interface.md's list without timing.json), each whole or not at all;
/// adds their checksums to manifest.json. Throws io.
template <int Dim>
void save_outputs(const std::filesystem::path& folder, const RunOutputs<Dim>& run, Observer* observer);

}  // namespace vantage
