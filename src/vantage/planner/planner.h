// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/incidence.h"
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

/// The elevations that a scan can say something of, as sines; all by default.
struct Elevations {
  double lowest = -1.0, highest = 1.0;
  bool by_hits = false;   ///< Of each scan no higher than its highest hit: a cloud without the rays that met nothing says nothing of the sky.
  bool each_way = false;  ///< The highest hit of every azimuth counts for itself: rays that met nothing say nothing, wherever they went.
};

/// Where a scanner may be put, if not wherever reachable_nodes() says: the nodes (1), given the belief and where we are.
template <int Dim>
struct StationRule {
  std::function<Field<Dim, std::uint8_t>(const BeliefView<Dim>&, const Vec<Dim>& here)> places;
  bool all = false;  ///< Every such node is a candidate (a layer above the ground has no medial axis); false: the medial ones.
  /// Where exactly a scanner stands that is put near such a node; of several candidates there only the nearest node counts. None: at the node.
  std::function<Vec<Dim>(const BeliefView<Dim>&, const Vec<Dim>& node)> stand = {};
  std::function<double(const Vec<Dim>&)> worth = {};  ///< Times the weight w of a place [1]; none: 1 everywhere.
  std::optional<Elevations> coverage = {};            ///< Nothing is expected of other directions; none: of all.
};

/// What is wanted of a list of places to scan from.
template <int Dim>
struct RankRequest {
  std::int64_t count = 5;
  double apart = 0.0;                  ///< At least so far from each other and from `planned` [m].
  double overlap = 0.0;                ///< Least share of known surface in what is in view, for registration [1].
  std::vector<Vec<Dim>> planned = {};  ///< Stations already planned: what they will show is not counted again.
  std::vector<Vec<Dim>> among = {};    ///< Only these places, wherever they are; empty: the candidates of the last decision.
  double least_cosine = 0.0;           ///< Between ray and normal: what is met flatter shows nothing, and known surface not well; 0: any [1].
  /// Known surface that was only seen flatter. Beside E a place counts what it would show of this well, as a share of the most that any place faces
  /// of it or of the shadow boundary.
  std::vector<SurfacePiece<Dim>> mend = {};
};

/// A place to scan from, beside the others of a list.
template <int Dim>
struct RankedPlace {
  Vec<Dim> position = Vec<Dim>::Zero();  ///< [m]
  double score = 0.0;                    ///< E, what the better places and the planned ones will show discounted.
  double new_volume = 0.0;               ///< Expected of it alone [m^Dim].
  double added_volume = 0.0;             ///< The same without what the better places and the planned ones will show [m^Dim].
  double new_area = 0.0;                 ///< Eq. (1) with line of sight: shadow boundary that faces it, in view [m^(Dim-1)].
  double overlap = 0.0;                  ///< Share of known surface in what is in view [1].
  std::vector<Vec<Dim>> path;            ///< From where we are [m].
  double mended = 0.0;                   ///< Of RankRequest::mend, beyond the better places [m^(Dim-1)].
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
  /// From now on only these places, and paths through them.
  void set_rule(StationRule<Dim> rule) { rule_ = std::move(rule); }

  /// The best places as of the last decision, best first: the first is the decision's own where nothing else is asked for; each next one is the best
  /// when what those before it are expected to show counts no more. Places that would show less than stop_volume are left out.
  [[nodiscard]] std::vector<RankedPlace<Dim>> rank(const BeliefView<Dim>& view, const RankRequest<Dim>& request) const;

  /// Where one may stand, as of the last decision (1, else 0).
  [[nodiscard]] const Field<Dim, std::uint8_t>& reachable() const { return reachable_; }

  /// From where we are to a place, over the reachable node nearest to it, as of the last decision.
  [[nodiscard]] std::vector<Vec<Dim>> way_to(const Vec<Dim>& place) const;

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
  struct Ranking;
  [[nodiscard]] std::vector<Scored> score_by_rays(const BeliefView<Dim>& view, std::span<const std::size_t> nodes);
  [[nodiscard]] std::vector<Scored> score_by_boundary(const BeliefView<Dim>& view, std::span<const std::size_t> nodes) const;
  [[nodiscard]] std::vector<Scored> score_by_baseline(const BeliefView<Dim>& view, std::span<const std::size_t> nodes,
                                                      std::span<const std::size_t> medial);
  [[nodiscard]] std::vector<Scored> score_by_optimism(const BeliefView<Dim>& view, std::span<const std::size_t> medial);
  [[nodiscard]] typename Decision<Dim>::End end_of(const Decision<Dim>& decision, double seen_volume);
  [[nodiscard]] double after_travel(std::size_t node) const;
  [[nodiscard]] const Scored& best_of(std::span<const Scored> scored, const Vec<Dim>& here) const;
  [[nodiscard]] const Scored& first_of_best_pair(const BeliefView<Dim>& view, std::span<const Scored> scored) const;
  void look_again(const BeliefView<Dim>& view, Decision<Dim>& decision, double seen_volume);
  [[nodiscard]] std::vector<Vec<Dim>> covered(const RayMarch<Dim>& march, const Vec<Dim>& place, std::span<const Vec<Dim>> directions) const;
  [[nodiscard]] RaySums look(const RayMarch<Dim>& march, const Vec<Dim>& place, std::span<const Vec<Dim>> directions) const;
  [[nodiscard]] double mix(const RaySums& sums) const;
  void set_scale(std::span<const Scored> scored);
  [[nodiscard]] RayMarch<Dim> rays(const BeliefView<Dim>& view) const;
  [[nodiscard]] RayMarch<Dim> rays(const BeliefView<Dim>& view, const Field<Dim>* weight) const;
  [[nodiscard]] std::vector<Vec<Dim>> path_to(std::size_t node) const;
  [[nodiscard]] std::size_t nearest_place(const Vec<Dim>& place) const;
  [[nodiscard]] Vec<Dim> place_at(const BeliefView<Dim>& view, std::size_t node) const;
  void go_to(const BeliefView<Dim>& view, std::size_t node, Decision<Dim>& decision) const;
  [[nodiscard]] std::vector<std::size_t> candidates(const BeliefView<Dim>& view) const;

  PlannerOptions options_;
  double max_range_;
  std::uint64_t seed_;
  OpeningModel<Dim> opening_;
  std::vector<Vec<Dim>> visited_;
  Field<Dim, std::uint8_t> reachable_;
  std::size_t first_ = kNoNode;  // Reachable node beside us, where ways begin.
  Field<Dim> walk_;              // From the last scan to every reachable node [m]; empty: it does not count.
  MarchGrid<Dim> grid_;          // Of the last decision's belief.
  std::optional<LazyPool<Dim>> pool_;
  Field<Dim> weight_;  // w per node; empty: 1 everywhere.
  StationRule<Dim> rule_;
  std::vector<std::pair<std::size_t, double>> last_;  // Candidates of the last decision and their E, best first.
  RaySums scale_;                                     // Largest of each term over the candidates of the last decision.
  double opacity_ = 0.0;
  std::function<std::vector<Patch<Dim>>()> surface_;
  LastLooks<Dim> looks_;
  Glimpses<Dim> glimpses_;
  LastLook last_look_, squeezed_;              // Empty while there is better to do.
  int below_ = 0, idle_ = 0, last_looks_ = 0;  // Picks in a row.
  std::int64_t all_last_looks_ = 0;
};

}  // namespace vantage
