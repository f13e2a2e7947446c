// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "vantage/field/belief_view.h"

namespace vantage::bench {

/// What OctoMap information gain chooses among `views`.
struct PeerChoice {
  double cpu = 0.0;         ///< 4,050 castRay a view, up to the first unknown voxel [s].
  double cpu_volume = 0.0;  ///< And on to the next occupied one [s].
  std::size_t most_rays = 0, most_volume = 0;
};

/// The belief as an octree of free and occupied voxels, pruned; none without OctoMap.
[[nodiscard]] std::optional<PeerChoice> octomap_choice(const BeliefView<3>& view, std::span<const Vec<3>> views, double range);

}  // namespace vantage::bench
