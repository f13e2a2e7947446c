// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>

#include "vantage/audit/coverage.h"
#include "vantage/audit/oracle.h"
#include "vantage/explore/explore.h"

namespace vantage {

/// How good a run was, judged by the truth.
template <int Dim>
  requires SpatialDim<Dim>
struct RunScore {
  std::vector<Vec<Dim>> places;       ///< Of the scans, in their order [m].
  std::vector<double> coverage;       ///< Share of the reference set seen after each [1].
  std::vector<double> path;           ///< Way up to each [m].
  Coverage last;                      ///< After the last scan.
  double falsely_hidden = 0.0;        ///< At the end, see falsely_hidden(); only of a trial [m^Dim].
  bool finished = false;              ///< The explorer ended by itself, or at its own limit.
  Verdict<Dim> verdict;               ///< What it said at the end.
  bool verdict_right = false;         ///< See verdict_right(); false if it has not finished.
  std::optional<double> thin_recall;  ///< See ThinParts; only of a trial [1].

  [[nodiscard]] std::optional<std::int64_t> scans_to(double share) const { return vantage::scans_to(coverage, share); }
};

/// When to stop stepping although the explorer has not finished.
struct ScoreLimits {
  std::int64_t max_scans = std::numeric_limits<std::int64_t>::max();
  double coverage = 2.0;         ///< Enough is seen; above 1: never.
  bool to_the_end = false;       ///< Where enough is seen, go on until the explorer finishes; then max_scans limits only the way up to there.
  Observer* observer = nullptr;  ///< May stop it.
};

/// Chooses the next place in the planner's stead.
template <int Dim>
  requires SpatialDim<Dim>
class Pilot {
 public:
  virtual ~Pilot() = default;
  /// After every step: a node of explorer.reachable(), or nullopt for the place the planner proposes.
  [[nodiscard]] virtual std::optional<Vec<Dim>> next(const Explorer<Dim>& explorer) = 0;
};

/// Scans after the first, up to the one that reaches 99 %, that added less than 0.1 % of the reference set.
[[nodiscard]] std::int64_t idle_picks(std::span<const double> coverage);

/// Was "complete" said exactly when at least 99 % were seen, and did the true share lie within the stated bounds? What shows only through something
/// as narrow as the lattice spacing may be counted or left out.
template <int Dim>
[[nodiscard]] bool verdict_right(const Verdict<Dim>& verdict, const Coverage& truth);

/// Steps the explorer to its end or a limit and judges the map after every scan. With a pilot it goes where that says, but ends when it would.
/// Throws interrupted when the observer asks to stop.
template <int Dim>
[[nodiscard]] RunScore<Dim> score_run(Explorer<Dim>& explorer, const Reference<Dim>& reference, const ScoreLimits& limits = {},
                                      Pilot<Dim>* pilot = nullptr);

}  // namespace vantage
