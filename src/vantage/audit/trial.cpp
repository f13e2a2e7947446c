// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/trial.h"

#include "vantage/audit/coverage.h"
#include "vantage/audit/information_gain.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

ReferenceOptions reference_options(const TrialOptions& options) {
  ReferenceOptions o;
  o.voxel = options.explore.voxel;
  o.eta = options.explore.surface.eta;
  o.clearance = options.explore.planner.clearance;
  o.range = options.lidar.pattern.max_range;
  return o;
}

/// Passes scans on and shows their returns to the thin parts.
template <int Dim>
class Watched final : public Sensor<Dim> {
 public:
  Watched(Sensor<Dim>& inner, ThinParts<Dim>& thin) : inner_(inner), thin_(thin) {}
  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>& vantage_point, int index) override {
    Scan<Dim> scan = inner_.scan(vantage_point, index);
    if (!thin_.empty()) thin_.observe(hit_points(scan));
    return scan;
  }

 private:
  Sensor<Dim>& inner_;
  ThinParts<Dim>& thin_;
};

}  // namespace

template <int Dim>
TrialOptions trial_options(const Scene<Dim>& scene) {
  TrialOptions options;
  options.explore.voxel = scene.voxel;
  options.explore.snapshots = false;
  options.explore.surface.eta = scene.eta;
  options.explore.planner.clearance = scene.clearance;
  options.lidar.pattern.max_range = scene.range;
  return options;
}

template <int Dim>
  requires SpatialDim<Dim>
Trial<Dim>::Trial(const Scene<Dim>& scene, const TrialOptions& options)
    : scene_(scene), truth_(scene.mesh), reference_(make_reference(truth_, scene.domain, scene.start, reference_options(options))), thin_(scene) {}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<Vec<Dim>> Trial<Dim>::starts(std::int64_t count, std::int64_t seed) const {
  std::vector<std::size_t> reachable;
  for (std::size_t i = 0; i < reference_.nodes.values.size(); ++i)
    if (reference_.nodes[i].reachable) reachable.push_back(i);
  Random random(static_cast<std::uint64_t>(seed));
  std::vector<Vec<Dim>> places;
  for (std::int64_t k = 0; k < count; ++k) places.push_back(reference_.nodes.window.position(reachable[random.below(reachable.size())]));
  return places;
}

template <int Dim>
  requires SpatialDim<Dim>
Walls<Dim> Trial<Dim>::walls(const WallOptions& options) const {
  return reachable_walls(reference_, scene_, truth_, options);
}

template <int Dim>
  requires SpatialDim<Dim>
SightTable<Dim> Trial<Dim>::sight_table(const Vec<Dim>& start, const OracleOptions& options, const Walls<Dim>* walls) const {
  return make_sight_table<Dim>({reference_, truth_, walls}, start, options);
}

template <int Dim>
  requires SpatialDim<Dim>
RunScore<Dim> Trial<Dim>::run(const Vec<Dim>& start, const TrialOptions& options, const ScoreLimits& limits) const {
  SimulatedLidar<Dim> lidar(scene_.mesh, options.lidar);
  return run(lidar, start, options, limits);
}

template <int Dim>
  requires SpatialDim<Dim>
RunScore<Dim> Trial<Dim>::run(Sensor<Dim>& sensor, const Vec<Dim>& start, const TrialOptions& options, const ScoreLimits& limits) const {
  ThinParts<Dim> thin = thin_;
  std::optional<InformationGain<Dim>> peer;
  if (options.information_gain) peer.emplace(sensor, scene_.domain, typename InformationGain<Dim>::Options{.voxel = options.explore.voxel});
  Watched<Dim> watched(peer ? *peer : sensor, thin);
  Explorer<Dim> explorer(watched, scene_.domain, start, options.explore, limits.observer);
  RunScore<Dim> score = score_run(explorer, reference_, limits, peer ? static_cast<Pilot<Dim>*>(&*peer) : nullptr);
  score.falsely_hidden = falsely_hidden<Dim>(reference_, truth_, explorer.states(), score.places);
  if (!thin.empty()) score.thin_recall = thin.recall(explorer.surface().patches());
  return score;
}

template TrialOptions trial_options<2>(const Scene<2>&);
template TrialOptions trial_options<3>(const Scene<3>&);
template class Trial<2>;
template class Trial<3>;

}  // namespace vantage
