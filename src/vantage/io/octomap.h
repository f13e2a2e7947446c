// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "vantage/geometry/vec.h"
#include "vantage/io/bytes.h"

namespace vantage {

/// What an OctoMap binary file (.bt) knows: cubes that are free or occupied; all else is unknown.
struct OccupancyTree {
  struct Leaf {
    Vec<3> centre;  ///< [m]
    double side;    ///< resolution * 2^k [m]
    bool occupied;
  };
  double resolution = 0.0;   ///< Side of the smallest cube [m].
  std::vector<Leaf> leaves;  ///< Depth first, as the file has them.
};

/// Throws io, or bad_input naming `FILE:OFFSET`.
[[nodiscard]] OccupancyTree read_occupancy_tree(const std::filesystem::path& path);
/// The same from memory.
[[nodiscard]] OccupancyTree parse_occupancy_tree(FileBytes file);

}  // namespace vantage
