// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <variant>
#include <vector>

#include "vantage/geometry/vec.h"

namespace vantage {

/// Points of a plane or of space, not-finite ones included, (N, Dim) [m].
using AnyPoints = std::variant<std::vector<Vec<2>>, std::vector<Vec<3>>>;

/// All points of point clouds, scan logs and run folders, one after the other. Throws io, or bad_input for a malformed file or a mixture of
/// plane and space.
[[nodiscard]] AnyPoints read_clouds(std::span<const std::filesystem::path> paths);

/// The same, each cloud and each scan of a log for itself.
[[nodiscard]] std::vector<AnyPoints> read_scans(std::span<const std::filesystem::path> paths);

}  // namespace vantage
