// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/ending.h"

#include <algorithm>
#include <cmath>

#include "vantage/audit/coverage.h"
#include "vantage/base/error.h"
#include "vantage/field/distance.h"
#include "vantage/world/inside_solid.h"

namespace vantage {
namespace {

constexpr std::int64_t kMostScans = 150;  // A small scene needs a dozen or two.

/// Follows an explorer and looks at every move it plans.
template <int Dim>
class Watch {
 public:
  Watch(const RayCaster<Dim>& truth, const TrialOptions& options) : truth_(truth), options_(options) {}

  /// After a step.
  void look(const Explorer<Dim>& explorer, Ending& ending) {
    const Vec<Dim>& here = explorer.steps().back().vantage;
    const double h = options_.explore.voxel;
    for (const Vec<Dim>& earlier : places_) ending.repeated += (here - earlier).norm() < 0.5 * h ? 1 : 0;
    ending.collisions += inside_solid(truth_, here) ? 1 : 0;
    places_.push_back(here);
    const std::vector<Vec<Dim>>& way = explorer.path();
    if (!explorer.finished()) look_at_way(explorer, std::span(way).subspan(known_way_), ending);
    known_way_ = way.size();
  }

 private:
  void look_at_way(const Explorer<Dim>& explorer, std::span<const Vec<Dim>> way, Ending& ending) {
    const Field<Dim, NodeState> states = explorer.states();
    const Grid<Dim>& grid = states.window;
    const double clearance = options_.explore.planner.clearance;
    const Field<Dim> known = distance_to_patches<Dim>(explorer.surface().patches(), grid, 2.0 * clearance + 2.0 * grid.spacing);
    const Vec<Dim>& here = places_.back();
    // Where the scanner stands closer than the clearance, as a start may, it may leave through what is near, and with the first step
    // wherever the known distances of its ends leave no room for a surface (candidates.h).
    const Index<Dim> home = grid.nearest(here);
    const bool cramped = grid.inside(home) && static_cast<double>(known.at(home)) < clearance;
    const double near = cramped ? 2.0 * clearance + 2.0 * grid.spacing : std::sqrt(static_cast<double>(Dim)) * grid.spacing;
    const auto free_around = [&](const Vec<Dim>& end, const Vec<Dim>& p) {
      const Index<Dim> node = grid.nearest(end);
      return static_cast<double>(known.at(node)) - (grid.position(node) - end).norm() > (p - end).norm();
    };
    const auto safe = [&](const Vec<Dim>& p) {
      const Index<Dim> node = grid.nearest(p);
      if (!grid.inside(node)) return false;
      if (((cramped ? grid.position(node) : p) - here).norm() <= near && (cramped || places_.size() == 1))
        return states.at(node) != NodeState::obstacle || node == home;
      return states.at(node) == NodeState::seen &&
             static_cast<double>(known.at(node)) >= clearance - 0.25 * grid.spacing;  // Distances are approximate.
    };
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Vec<Dim> piece = way[i] - way[i - 1];
      ending.collisions += in_sight(truth_, way[i - 1], way[i]) ? 0 : 1;
      const int samples = static_cast<int>(std::ceil(piece.norm() / (0.2 * grid.spacing)));
      bool all_safe = true;
      for (int k = 0; k <= samples; ++k) {
        const Vec<Dim> p = way[i - 1] + piece * (static_cast<double>(k) / std::max(1, samples));
        const bool stepping_out = cramped && i == 1 && (free_around(way[0], p) || free_around(way[1], p));
        all_safe = all_safe && (stepping_out || safe(p));
        ending.least_clearance = std::min(ending.least_clearance, truth_.distance(p, 1.0));
      }
      ending.unsafe += all_safe ? 0 : 1;
    }
  }

  const RayCaster<Dim>& truth_;
  const TrialOptions& options_;
  std::vector<Vec<Dim>> places_;
  std::size_t known_way_ = 0;
};

/// Do the records bear out the reason?
template <int Dim>
bool bears_out(const Explorer<Dim>& explorer, const PlannerOptions& options) {
  const std::vector<StepRecord<Dim>>& steps = explorer.steps();
  const Verdict<Dim> verdict = explorer.verdict();
  switch (verdict.end) {
    case StopReason::none: return false;
    case StopReason::nothing_can_open: return !(steps.back().expected_volume > 0.0);
    case StopReason::below_threshold:
      return steps.size() >= 2 &&
             std::all_of(steps.end() - 2, steps.end(), [&](const auto& s) { return s.expected_volume < options.stop_volume * s.seen_volume; });
    case StopReason::idle:
      return static_cast<std::int64_t>(steps.size()) > options.idle_limit &&
             std::all_of(steps.end() - options.idle_limit, steps.end(), [](const auto& s) { return s.new_volume < 1e-5 * s.seen_volume; });
    case StopReason::unreachable: return steps.back().candidates == 0 && verdict.unseen_volume > 0.0;
  }
  return false;
}

template <int Dim>
ReferenceOptions reference_options(const TrialOptions& options) {
  return {.voxel = options.explore.voxel,
          .eta = options.explore.surface.eta,
          .clearance = options.explore.planner.clearance,
          .range = options.lidar.pattern.max_range,
          .rays = 2400 - 700 * Dim};
}

template <int Dim>
Ending play_small(const SmallScene& name, const AdjustOptions& adjust, Observer* observer) {
  const Scene<Dim> scene = make_small_scene<Dim>(name.kind, name.seed);
  TrialOptions options = small_options(scene);
  if (adjust) adjust(options);
  return play_to_end(scene, options, observer);
}

}  // namespace

template <int Dim>
TrialOptions small_options(const Scene<Dim>& scene) {
  TrialOptions options = trial_options(scene);
  options.explore.max_scans = kMostScans;
  options.lidar.pattern.step = radians(2.0 * Dim - 3.0);
  options.lidar.pattern.vertical_fov = kPi - options.lidar.pattern.step;
  return options;
}

template <int Dim>
Ending play_to_end(const Scene<Dim>& scene, const TrialOptions& options, Observer* observer) {
  Ending ending;
  try {
    const RayCaster<Dim> truth(scene.mesh);
    const Reference<Dim> reference = make_reference(truth, scene.domain, scene.start, reference_options<Dim>(options));
    SimulatedLidar<Dim> lidar(scene.mesh, options.lidar);
    Explorer<Dim> explorer(lidar, scene.domain, scene.start, options.explore, observer);
    Watch<Dim> watch(truth, options);
    while (!explorer.finished()) {
      explorer.step();
      watch.look(explorer, ending);
      if (observer != nullptr && observer->stop_requested()) throw Error(ErrorCode::interrupted, "stopped");
    }
    const Coverage now = coverage(reference, explorer.states());
    const Verdict<Dim> verdict = explorer.verdict();
    ending.scans = static_cast<std::int64_t>(explorer.steps().size());
    ending.ended = verdict.end != StopReason::none;
    ending.reason_true = bears_out(explorer, options.explore.planner);
    ending.verdict_right = verdict_right(verdict, now);
    ending.falsely_free = now.falsely_free;
    ending.share = now.fraction;
    ending.widely = now.widely;
    ending.complete = verdict.complete;
    ending.low = verdict.seen_low;
    ending.high = verdict.seen_high;
    ending.reason = verdict.reason;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::interrupted) throw;
    ending.error = error.what();
  }
  return ending;
}

Ending play_to_end(const SmallScene& scene, const AdjustOptions& adjust, Observer* observer) {
  return scene.dim == 2 ? play_small<2>(scene, adjust, observer) : play_small<3>(scene, adjust, observer);
}

template TrialOptions small_options<2>(const Scene<2>&);
template TrialOptions small_options<3>(const Scene<3>&);
template Ending play_to_end<2>(const Scene<2>&, const TrialOptions&, Observer*);
template Ending play_to_end<3>(const Scene<3>&, const TrialOptions&, Observer*);

}  // namespace vantage
