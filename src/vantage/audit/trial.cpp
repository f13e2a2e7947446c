// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/trial.h"

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
    : scene_(scene), truth_(scene.mesh), reference_(make_reference(truth_, scene.domain, scene.start, reference_options(options))) {}

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
SightTable<Dim> Trial<Dim>::sight_table(const Vec<Dim>& start, const OracleOptions& options) const {
  return make_sight_table(reference_, truth_, start, options);
}

template <int Dim>
  requires SpatialDim<Dim>
RunScore<Dim> Trial<Dim>::run(const Vec<Dim>& start, const TrialOptions& options, const ScoreLimits& limits) const {
  SimulatedLidar<Dim> lidar(scene_.mesh, options.lidar);
  Explorer<Dim> explorer(lidar, scene_.domain, start, options.explore);
  return score_run(explorer, reference_, limits);
}

template TrialOptions trial_options<2>(const Scene<2>&);
template TrialOptions trial_options<3>(const Scene<3>&);
template class Trial<2>;
template class Trial<3>;

}  // namespace vantage
