// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "vantage/session/point_filter.h"
#include "vantage/surface/surface.h"

namespace vantage {

/// What a file holds of one scan.
template <int Dim>
struct ScannedPoints {
  std::vector<Vec<Dim>> points;              ///< Not-finite ones included, (N, Dim) [m].
  std::optional<SurfaceSensor<Dim>> sensor;  ///< Where a log knows it.
};

/// Scans of a plane or of space.
using AnyScans = std::variant<std::vector<ScannedPoints<2>>, std::vector<ScannedPoints<3>>>;

/// Each point cloud, and each scan of scan logs and run folders. Throws io, or bad_input for a malformed file or a mixture of plane and space.
[[nodiscard]] AnyScans read_scans(std::span<const std::filesystem::path> paths);
/// The same without the points that the filter takes out, which are added to `report`. Throws bad_input for a scan of a plane, or one without the
/// place it was taken from.
[[nodiscard]] AnyScans read_scans(std::span<const std::filesystem::path> paths, const FilterOptions& filter, FilterReport* report);

/// All their points, one scan after the other.
template <int Dim>
[[nodiscard]] std::vector<Vec<Dim>> joined(std::span<const ScannedPoints<Dim>> scans) {
  std::vector<Vec<Dim>> all;
  for (const ScannedPoints<Dim>& scan : scans) all.insert(all.end(), scan.points.begin(), scan.points.end());
  return all;
}

}  // namespace vantage
