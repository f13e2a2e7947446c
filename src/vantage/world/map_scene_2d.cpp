// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/map_scene_2d.h"

#include <algorithm>
#include <vector>

#include "vantage/base/error.h"
#include "vantage/world/scene_file.h"

namespace vantage {
namespace {

/// Lattice that still shows what a map's cells show, unless the map is huge.
double voxel_of(const OccupancyMap& map) {
  const double longest = std::max(map.width, map.height) * map.resolution;
  return nice_number(std::max(2.0 * map.resolution, longest / 1500.0));
}

/// Per cell the steps, also diagonal ones, to the nearest cell that is not free; 0 for those.
std::vector<int> depths(const OccupancyMap& map) {
  const int w = map.width, h = map.height;
  std::vector<int> depth(map.cells.size());
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= w || y >= h ? 0 : depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x)];
  };
  const auto sweep = [&](int x, int y, int back) {
    if (map.at(x, y) != CellState::free) return 0;
    return 1 + std::min({at(x - back, y), at(x - 1, y - back), at(x, y - back), at(x + 1, y - back)});
  };
  std::size_t i = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x, ++i) depth[i] = sweep(x, y, 1);
  for (int y = h - 1; y >= 0; --y)
    for (int x = w - 1; x >= 0; --x) {
      --i;
      depth[i] = std::min(depth[i], sweep(x, y, -1));
    }
  return depth;
}

/// Cells of the largest part of `depth` >= least that hangs together by cells' sides; the first of equals.
std::vector<std::size_t> largest_part(const std::vector<int>& depth, int width, int least) {
  std::vector<char> seen(depth.size(), 0);
  std::vector<std::size_t> best, part;
  const auto w = static_cast<std::size_t>(width);
  for (std::size_t start = 0; start < depth.size(); ++start) {
    if (seen[start] || depth[start] < least) continue;
    part.assign(1, start);
    seen[start] = 1;
    const auto visit = [&](std::size_t cell) {
      if (!seen[cell] && depth[cell] >= least) seen[cell] = 1, part.push_back(cell);
    };
    for (std::size_t next = 0; next < part.size(); ++next) {
      const std::size_t cell = part[next], x = cell % w;
      if (x > 0) visit(cell - 1);
      if (x + 1 < w) visit(cell + 1);
      if (cell >= w) visit(cell - w);
      if (cell + w < depth.size()) visit(cell + w);
    }
    if (part.size() > best.size()) best.swap(part);
  }
  return best;
}

Vec<2> start_of(const OccupancyMap& map, double clearance) {
  const std::vector<int> depth = depths(map);
  std::vector<std::size_t> part;
  for (int least = 1 + static_cast<int>(clearance / map.resolution); part.empty(); least /= 2)
    part = largest_part(depth, map.width, std::max(least, 1));
  const std::size_t widest =
      *std::max_element(part.begin(), part.end(), [&](std::size_t a, std::size_t b) { return depth[a] != depth[b] ? depth[a] < depth[b] : a > b; });
  const auto w = static_cast<std::size_t>(map.width);
  return map.position(static_cast<double>(widest % w) + 0.5, static_cast<double>(widest / w) + 0.5);
}

}  // namespace

Scene<2> map_scene(const OccupancyMap& map, const std::string& name, const std::string& where) {
  require(std::find(map.cells.begin(), map.cells.end(), CellState::free) != map.cells.end(), "map without a free cell", where);
  Scene<2> scene;
  scene.name = name;
  scene.mesh = walls(map);
  const auto count = static_cast<std::uint32_t>(scene.mesh.facets.size());
  scene.parts = {{"walls", 0, count - 4}, {"frame", count - 4, 4}};
  scene.voxel = scene.clearance = voxel_of(map);
  scene.eta = std::min(map.resolution, 0.5 * scene.voxel);  // Slanting walls are stairs of one cell.
  for (std::uint32_t f = 0; f < count - 4; ++f)
    for (const std::uint32_t v : scene.mesh.facets[f]) scene.domain.extend(scene.mesh.vertices[v]);
  scene.domain = scene.domain.grown(scene.voxel);
  scene.start = start_of(map, scene.clearance);
  return scene;
}

}  // namespace vantage
