// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/audit/score.h"
#include "vantage/audit/thin_parts.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"

namespace vantage {

/// Everything a run depends on but the scene and the start.
struct TrialOptions {
  ExploreOptions explore;
  LidarOptions lidar;
  bool information_gain = false;  ///< The next place is chosen by OctoMap information gain (information_gain.h).
};

/// Lattice, eta, clearance and range that suit the scene; the rest as it stands by default.
template <int Dim>
[[nodiscard]] TrialOptions trial_options(const Scene<Dim>& scene);

/// A place whose truth is known, in which runs and oracles are compared.
template <int Dim>
  requires SpatialDim<Dim>
class Trial {
 public:
  /// Finds the reachable visible volume from the scene's start; lattice, eta, clearance and range are those of `options`.
  Trial(const Scene<Dim>& scene, const TrialOptions& options);

  [[nodiscard]] const Scene<Dim>& scene() const { return scene_; }
  [[nodiscard]] const RayCaster<Dim>& truth() const { return truth_; }
  [[nodiscard]] const Reference<Dim>& reference() const { return reference_; }
  /// Reachable free places drawn at random.
  [[nodiscard]] std::vector<Vec<Dim>> starts(std::int64_t count, std::int64_t seed) const;
  /// The surface that can be seen, with or without clutter.
  [[nodiscard]] Walls<Dim> walls(const WallOptions& options = {}) const;
  /// What the oracles choose from; their first scan is taken at `start`.
  [[nodiscard]] SightTable<Dim> sight_table(const Vec<Dim>& start, const OracleOptions& options = {}, const Walls<Dim>* walls = nullptr) const;
  /// A run of the explorer from `start` with a simulated scanner, judged after every scan. `options` has the lattice of the reference.
  [[nodiscard]] RunScore<Dim> run(const Vec<Dim>& start, const TrialOptions& options, const ScoreLimits& limits = {}) const;
  /// The same with scans from elsewhere.
  [[nodiscard]] RunScore<Dim> run(Sensor<Dim>& sensor, const Vec<Dim>& start, const TrialOptions& options, const ScoreLimits& limits = {}) const;

 private:
  Scene<Dim> scene_;
  RayCaster<Dim> truth_;
  Reference<Dim> reference_;
  ThinParts<Dim> thin_;
};

}  // namespace vantage
