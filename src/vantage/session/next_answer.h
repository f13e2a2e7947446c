// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "vantage/explore/explore.h"
#include "vantage/report/report.h"
#include "vantage/session/next_options.h"
#include "vantage/session/next_tour.h"
#include "vantage/session/result.h"

namespace vantage {

/// Where to scan next, of an explorer that has gone through all scans.
template <int Dim>
struct NextAnswer {
  std::vector<RankedPlace<Dim>> ranked;  ///< Best first.
  NextTour<Dim> tour;                    ///< Past all of them, from the last scan.
  Verdict<Dim> verdict;
  FlatSurface<Dim> flat;  ///< Only ever seen flatter than the limit.
  double limit = 90.0;    ///< [deg]
};

/// `scan(k)` is asked for, one after the other, if there is a limit on the incidence. What had to be left out is added to `notes`.
template <int Dim>
[[nodiscard]] NextAnswer<Dim> next_answer(const Explorer<Dim>& explorer, const NextOptions& options, const std::function<Scan<Dim>(int)>& scan,
                                          std::vector<std::string>& notes);

/// What the report shows around the places.
template <int Dim>
[[nodiscard]] NextPlan<Dim> next_plan(const NextAnswer<Dim>& answer, const NextOptions& options);

/// What `vantage next --json` prints, but for what only the caller knows.
template <int Dim>
[[nodiscard]] Json answer_json(const NextAnswer<Dim>& answer, const Explorer<Dim>& explorer);

/// A row for every ranked place.
template <int Dim>
[[nodiscard]] std::string next_csv(const NextAnswer<Dim>& answer);

}  // namespace vantage
