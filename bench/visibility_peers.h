// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <ctime>
#include <span>
#include <string>
#include <vector>

#include "vantage/field/grid.h"
#include "vantage/geometry/mesh.h"

namespace vantage::bench {

/// Median CPU seconds of a few runs.
template <class Work>
double seconds(int repeats, Work&& work) {
  std::vector<double> times;
  const auto now = [] {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  for (int i = 0; i < repeats; ++i) {
    const double begin = now();
    work();
    times.push_back(now() - begin);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats / 2)];
}

struct PeerTime {
  std::string name;
  double seconds = 0.0;      ///< CPU, for all nodes.
  double share_asked = 1.0;  ///< Of the nodes; the time is scaled up by the others.
};

/// One ray a node of `window` from `origin`, by whatever is built in: Embree on the triangles; OctoMap on the voxels (of the lattice's spacing) that
/// hold `points`. The window's extent along axis 0 is a multiple of 16.
[[nodiscard]] std::vector<PeerTime> visibility_peers(const Mesh<3>& mesh, std::span<const Vec<3>> points, const Vec<3>& origin,
                                                     const Grid<3>& window);

}  // namespace vantage::bench
