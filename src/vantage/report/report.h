// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vantage/explore/record.h"
#include "vantage/field/field.h"
#include "vantage/geometry/patch.h"
#include "vantage/planner/planner.h"
#include "vantage/surface/surface.h"

namespace vantage {

/// Everything the report shows of a run.
template <int Dim>
struct ReportInput {
  std::string scene;                                          ///< "town"
  std::string command;                                        ///< "vantage explore town"
  std::vector<std::pair<std::string, std::string>> settings;  ///< Name and value with unit, for the table at the end.
  Box<Dim> domain;
  std::vector<std::vector<Vec<Dim>>> scan_points;  ///< Hits per scan [m].
  std::vector<Patch<Dim>> patches;
  Field<Dim, NodeState> state;
  std::vector<Vec<Dim>> path;  ///< Through the vantage points, in order.
  std::vector<StepRecord<Dim>> steps;
  std::vector<Snapshot<Dim>> snapshots;
  Verdict<Dim> verdict;
  SurfaceStatistics surface;
  std::vector<RankedPlace<Dim>> next = {};  ///< Places to scan from next, best first; of a person's scans.
  std::vector<std::string> notes = {};      ///< What was assumed of them.
  int picture_width = 1400;                 ///< Of the large pictures [pixels].
};

/// One self-contained HTML page (no network, pictures inline).
template <int Dim>
[[nodiscard]] std::string render_report(const ReportInput<Dim>& input);

}  // namespace vantage
