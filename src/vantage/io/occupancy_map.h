// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/geometry/mesh.h"

namespace vantage {

enum class CellState : std::uint8_t { free, occupied, unknown };

/// A plan cut into square cells, as ROS keeps it.
struct OccupancyMap {
  int width = 0, height = 0;
  double resolution = 0.05;        ///< Side of a cell [m].
  Vec<2> origin = Vec<2>::Zero();  ///< Lower left corner of cell (0, 0) [m].
  double yaw = 0.0;                ///< Of the whole map, around `origin`, counterclockwise [rad].
  std::vector<CellState> cells;    ///< (height, width), from the lowest row.

  /// Outside the map all is unknown.
  [[nodiscard]] CellState at(int x, int y) const {
    const bool inside = x >= 0 && y >= 0 && x < width && y < height;
    return inside ? cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] : CellState::unknown;
  }
  /// Place of lattice corner (x, y), in cells [m].
  [[nodiscard]] Vec<2> position(double x, double y) const;
};

/// What the `.yaml` of a ROS map says, with what holds where it does not.
struct MapDescription {
  std::string image;                                         ///< Path, from the folder of the `.yaml`.
  double resolution = 0.05;                                  ///< Side of a cell [m].
  Vec<2> origin = Vec<2>::Zero();                            ///< Lower left corner [m].
  double yaw = 0.0;                                          ///< [rad]
  double occupied_threshold = 0.65, free_threshold = 0.196;  ///< Of darkness: occupied above, free below [1].
  bool negate = false;                                       ///< Light is dark.
};

/// Throws bad_input, naming the file and the line or key.
[[nodiscard]] MapDescription parse_map_description(const std::string& text, const std::string& name);

/// A ROS map: its `.yaml` (image, resolution, origin, negate, occupied_thresh, free_thresh), or the image alone (PNG, PGM) with the defaults,
/// 0.05 m a pixel. `resolution` > 0 replaces the file's [m]. Throws io; bad_input, naming the file and the key.
[[nodiscard]] OccupancyMap read_occupancy_map(const std::filesystem::path& path, double resolution = 0.0);

/// Whether the file's name ends like a map's.
[[nodiscard]] bool is_map_file(const std::filesystem::path& path);

/// Walls: the border of the free cells against occupied and unknown ones and the rim of the map, and one frame around everything. So all that is
/// not free is solid, no ray leaves the plan, and `inside_solid` holds. Straight runs are one segment each. The frame's four come last.
[[nodiscard]] Mesh<2> walls(const OccupancyMap& map);

}  // namespace vantage
