// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/explore/record.h"
#include "vantage/planner/planner.h"
#include "vantage/scan/scan.h"
#include "vantage/surface/surface.h"
#include "vantage/visibility/visibility.h"

namespace vantage {

/// All options of a run but the scene and the sensor.
struct ExploreOptions {
  double voxel = 0.5;            ///< Lattice spacing h [m].
  std::int64_t max_scans = 500;  ///< Stop after so many, complete or not.
  std::int64_t seed = 1;         ///< Of everything random in the planner.
  bool fill = true;              ///< Know flat walls between the rays of a scan (scan/fill.h).
  bool snapshots = true;         ///< Keep cuts through belief and metric for the report.
  SurfaceOptions surface;
  VisibilityOptions visibility;
  PlannerOptions planner;
};

/// The top-level ones (voxel, max_scans, seed, fill, snapshots); each stage describes its own.
void describe(ExploreOptions& options, const OptionVisitor& visit);

/// The loop of the paper's Fig. 1. It knows the place only through `sensor`. A function of (scans, options): a sensor that plays back logged
/// scans brings the same state again, bit for bit. A scan counts for where its `origin` says it was taken.
template <int Dim>
  requires SpatialDim<Dim>
class Explorer {
 public:
  /// Throws bad_input for wrong options or a start outside the domain, memory for a lattice that does not fit.
  Explorer(Sensor<Dim>& sensor, const Box<Dim>& domain, const Vec<Dim>& start, const ExploreOptions& options, Observer* observer = nullptr);
  ~Explorer();

  /// Where a scanner may be put; before the first step.
  void set_rule(StationRule<Dim> rule);

  /// One turn: scan, rebuild, see, unite, choose. Call while !finished().
  const StepRecord<Dim>& step();
  /// Takes the next scan at this node of reachable() instead of where the planner proposes; after a step, while !finished(). Throws bad_input for
  /// another place.
  void go_to(const Vec<Dim>& place);
  [[nodiscard]] bool finished() const;
  /// Why it ended, or how it stands.
  [[nodiscard]] Verdict<Dim> verdict() const;

  /// The best places to scan from next (Planner::rank), after a step.
  [[nodiscard]] std::vector<RankedPlace<Dim>> rank(const RankRequest<Dim>& request) const;
  /// Nodes of window() where one may stand (1, else 0), after a step.
  [[nodiscard]] const Field<Dim, std::uint8_t>& reachable() const;
  [[nodiscard]] BeliefView<Dim> view() const;

  [[nodiscard]] const Grid<Dim>& window() const;  ///< Over the whole domain.
  [[nodiscard]] const std::vector<StepRecord<Dim>>& steps() const;
  [[nodiscard]] const std::vector<Snapshot<Dim>>& snapshots() const;
  [[nodiscard]] const std::vector<Vec<Dim>>& path() const;  ///< Polyline through the vantage points so far and to the next.
  [[nodiscard]] const HausdorffTree<Dim>& surface() const;
  [[nodiscard]] Field<Dim, NodeState> states() const;  ///< Over the whole domain.
  [[nodiscard]] Field<Dim> psi() const;                ///< Signed distance to the shadow boundary, > 0 where seen [m].
  [[nodiscard]] Field<Dim> metric() const;             ///< E of the last step's candidates at their nodes, NaN elsewhere.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
