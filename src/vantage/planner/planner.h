// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/lazy_pool.h"
#include "vantage/planner/opening.h"
#include "vantage/planner/planner_options.h"
#include "vantage/planner/verdict.h"

namespace vantage {

/// Where to go next, or why nowhere.
template <int Dim>
struct Decision {
  bool found = false;
  Vec<Dim> position = Vec<Dim>::Zero();  ///< arg max E [m]
  double score = 0.0;                    ///< max E: mixed terms [1] for rays, Eq. (1) for the boundary sum [m^(Dim-1)], faces for `count`.
  double area = 0.0;                     ///< Eq. (1) with line of sight at the chosen place [m^(Dim-1)].
  double expected_volume = 0.0;          ///< Largest over the candidates [m^Dim].
  std::int64_t candidates = 0;           ///< Evaluated.
  std::vector<Vec<Dim>> path;            ///< From where we are to `position` [m].
  using End = StopReason;
  End end = End::none;
  std::vector<std::pair<std::size_t, float>> scored;  ///< Candidates (linear index) and their E.
};

/// Chooses vantage points by the visibility metric (paper Eq. 1, Sec. III-A). A function of the ordered scans: no hidden randomness.
template <int Dim>
  requires SpatialDim<Dim>
class Planner {
 public:
  /// `max_range` is the sensor's [m].
  Planner(const PlannerOptions& options, double max_range, std::uint64_t seed);

  /// arg max E after a scan at `here`, which saw `new_volume` for the first time [m^Dim].
  [[nodiscard]] Decision<Dim> choose(const BeliefView<Dim>& view, const Vec<Dim>& here, double new_volume);

  /// How to get the surface as known: before the end, places are sought that see through its gaps. Without it every obstacle node hides.
  void know_surface(std::function<std::vector<Patch<Dim>>()> surface) { surface_ = std::move(surface); }
  /// Takes note of where a scan's rays went although the belief calls it unseen; after the scan was united with the belief, before assess().
  void note(const BeliefView<Dim>& view, const Scan<Dim>& scan) { glimpses_.note(view, scan); }

  /// E at given places, by the same terms and scale as the last decision; for pictures. NaN where no vantage point may be. Baselines: the ray form.
  [[nodiscard]] std::vector<double> evaluate(const BeliefView<Dim>& view, std::span<const Vec<Dim>> places) const;

  /// Shares and regions as of the last decision.
  [[nodiscard]] Verdict<Dim> assess(const BeliefView<Dim>& view) const;

 private:
  struct Scored {
    std::size_t node = 0;
    RaySums sums;
    double score = 0.0;
  };
  [[nodiscard]] std::vector<Scored> score_by_rays(const BeliefView<Dim>& view, std::span<const std::size_t> nodes);
  [[nodiscard]] std::vector<Scored> score_by_boundary(const BeliefView<Dim>& view, std::span<const std::size_t> nodes) const;
  [[nodiscard]] std::vector<Scored> score_by_baseline(const BeliefView<Dim>& view, std::span<const std::size_t> nodes,
                                                      std::span<const std::size_t> medial);
  [[nodiscard]] std::vector<Scored> score_by_optimism(const BeliefView<Dim>& view, std::span<const std::size_t> medial);
  [[nodiscard]] typename Decision<Dim>::End end_of(const Decision<Dim>& decision, double seen_volume);
  void look_again(const BeliefView<Dim>& view, Decision<Dim>& decision);
  [[nodiscard]] double mix(const RaySums& sums) const;
  void set_scale(std::span<const Scored> scored);
  [[nodiscard]] RayMarch<Dim> rays(const BeliefView<Dim>& view) const;

  PlannerOptions options_;
  double max_range_;
  std::uint64_t seed_;
  OpeningModel<Dim> opening_;
  std::vector<Vec<Dim>> visited_;
  Field<Dim, std::uint8_t> reachable_;
  MarchGrid<Dim> grid_;  // Of the last decision's belief.
  std::optional<LazyPool<Dim>> pool_;
  Field<Dim> weight_;  // w per node; empty: 1 everywhere.
  RaySums scale_;      // Largest of each term over the candidates of the last decision.
  double opacity_ = 0.0;
  std::function<std::vector<Patch<Dim>>()> surface_;
  LastLooks<Dim> looks_;
  Glimpses<Dim> glimpses_;
  LastLook last_look_, squeezed_;              // Empty while there is better to do.
  int below_ = 0, idle_ = 0, last_looks_ = 0;  // Picks in a row.
};

}  // namespace vantage
