// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vantage/explore/record.h"
#include "vantage/field/field.h"
#include "vantage/geometry/patch.h"
#include "vantage/geometry/zone.h"
#include "vantage/planner/planner.h"
#include "vantage/surface/surface.h"

namespace vantage {

/// What stands around the places to scan from next.
template <int Dim>
struct NextPlan {
  std::vector<std::size_t> order;        ///< Of the places along the tour, from 0.
  std::vector<Vec<Dim>> tour;            ///< From the last scan past all of them [m].
  std::vector<Zone> keep_out, must_see;  ///< As asked for.
  std::vector<FlatRegion<Dim>> flat;     ///< Surface that was only seen flatter than a limit.
  double flat_area = 0.0;                ///< All of it [m^(Dim-1)].
};

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
  NextPlan<Dim> plan = {};
  std::vector<std::string> notes = {};  ///< What was assumed of them.
  int picture_width = 1400;             ///< Of the large pictures [pixels].
};

/// One self-contained HTML page (no network, pictures inline).
template <int Dim>
[[nodiscard]] std::string render_report(const ReportInput<Dim>& input);

}  // namespace vantage
