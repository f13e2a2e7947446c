// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "vantage/field/field.h"
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

/// An OctoMap binary file (.bt) of a lattice: what is seen is free, an obstacle occupied, all else unknown. A node fills the cube around it. The
/// cubes of OctoMap begin at multiples of its resolution, those of nodes half a spacing beside them, so the resolution is half the spacing: eight
/// cubes a node, joined where all eight of a larger one agree. A plane is one layer of cubes. Throws bad_input for a lattice that reaches beyond
/// OctoMap's 65536 cubes along an axis.
template <int Dim>
[[nodiscard]] std::string states_as_octomap(const Field<Dim, NodeState>& states);

}  // namespace vantage
