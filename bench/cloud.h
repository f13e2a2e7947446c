// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "vantage/world/scene.h"

namespace vantage::bench {

/// Scans one after the other, in the world's frame.
struct Cloud {
  Box<3> domain;                      ///< To be mapped [m].
  std::vector<Vec<3>> origins;        ///< Of the scans [m].
  std::vector<std::size_t> first{0};  ///< Of each scan in `points`, and the end.
  std::vector<Vec<3>> points;         ///< (N, 3) [m]

  [[nodiscard]] std::size_t scans() const { return origins.size(); }
  [[nodiscard]] std::span<const Vec<3>> scan(std::size_t i) const { return std::span(points).subspan(first[i], first[i + 1] - first[i]); }
  /// Points of the first `n` scans.
  [[nodiscard]] std::span<const Vec<3>> scans_before(std::size_t n) const { return std::span(points).first(first[n]); }
  void add(const Vec<3>& origin, std::span<const Vec<3>> hits);
};

/// `count` places to scan from, the scene's start first: of the free places 2 m above ground under the open sky that a walk from the start reaches,
/// each is the one farthest from those before. The first ones are thus the same for any count.
[[nodiscard]] std::vector<Vec<3>> stations(const Scene<3>& scene, std::size_t count);

/// Scans with the paper's sensor (0.5 degrees both ways, 80 m) from stations(scene, count), without what lies within 2.15 m of it (the vehicle
/// that carries it) or outside the scene's domain.
[[nodiscard]] Cloud scan_scene(const Scene<3>& scene, std::size_t count);

/// Places spread evenly over the true surface of the parts of that kind, those within 0.1 m of a point of the first `scans` scans: what was observed.
[[nodiscard]] std::vector<Vec<3>> observed_places(const Scene<3>& scene, const char* kind, std::span<const Vec<3>> points);

/// For the process that measures: machine's own byte order, no care for other readers.
void save(const Cloud& cloud, const std::filesystem::path& path);
/// The first `scans` scans of it, or all if there are fewer.
[[nodiscard]] Cloud load(const std::filesystem::path& path, std::size_t scans);

}  // namespace vantage::bench
