// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "vantage/base/error.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/io/mesh_file.h"
#include "vantage/io/occupancy_map.h"
#include "vantage/world/find_start.h"
#include "vantage/world/map_scene_2d.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// One path, or several joined by `+` unless a file has just that name.
std::vector<fs::path> split(const fs::path& spec) {
  std::error_code ignored;
  std::string rest = spec.string();
  if (fs::exists(spec, ignored)) return {spec};
  std::vector<fs::path> paths;
  for (std::size_t plus = rest.find('+'); plus != std::string::npos; plus = rest.find('+')) {
    paths.emplace_back(rest.substr(0, plus));
    rest.erase(0, plus + 1);
  }
  paths.emplace_back(rest);
  return paths;
}

MeshFileOptions mesh_options(const SceneFileOptions& options) {
  using Up = MeshFileOptions::Up;
  const Up up = options.up == SceneFileOptions::Up::y ? Up::y : options.up == SceneFileOptions::Up::z ? Up::z : Up::file;
  return {up, options.unit, options.detail};
}

/// The file's name without its endings: `delft.city.json` is delft.
std::string name_of(const fs::path& path) {
  const fs::path stem = path.stem();
  return stem.extension() == ".city" ? stem.stem().string() : stem.string();
}

void append(Scene<3>& scene, const Mesh<3>& mesh, const std::string& part) {
  const auto vertex = static_cast<std::uint32_t>(scene.mesh.vertices.size()), first = static_cast<std::uint32_t>(scene.mesh.facets.size());
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (auto facet : mesh.facets) {
    for (std::uint32_t& v : facet) v += vertex;
    scene.mesh.facets.push_back(facet);
  }
  scene.parts.push_back({part, first, static_cast<std::uint32_t>(mesh.facets.size())});
}

/// Level ground at height z below all of the mesh and as far beyond it as the domain is to reach, so that the rim of the place can be walked around.
void add_ground(Scene<3>& scene, double z) {
  constexpr double kRim = 0.05, kLeastRim = 2.0, kMostRim = 20.0;  // Of the mesh's longer side; [m].
  const Box<3> box = scene.mesh.bounds();
  require(z < box.high[2], fmt::format("scene.ground = {:g}: must be below the top of the scene, {:g} m", z, box.high[2]));
  const double side = box.size().head<2>().maxCoeff();
  require(box.low[2] - z <= std::max(side, box.size()[2]),
          fmt::format("scene.ground = {:g}: lies farther below the scene, {:g} m, than that is large", z, box.low[2]));
  const double rim = std::clamp(kRim * side, kLeastRim, kMostRim);
  const Vec<2> low = box.low.head<2>().array() - rim, high = box.high.head<2>().array() + rim;
  Mesh<3> ground;
  ground.vertices = {{low[0], low[1], z}, {high[0], low[1], z}, {high[0], high[1], z}, {low[0], high[1], z}};
  ground.facets = {{0, 1, 2}, {0, 2, 3}};
  append(scene, ground, "ground");
}

/// Domain, scales and start from the mesh. The domain begins at the ground and leaves 2 to 5 m of air above the highest roof.
void furnish(Scene<3>& scene) {
  const RayCaster<3> world(scene.mesh);
  scene.domain = scene.mesh.bounds();
  const double longest = scene.domain.size().maxCoeff();
  require(longest > 0.0 && longest < 1e7, fmt::format("the mesh spans {} m: must be > 0, < 1e7", longest), scene.name);
  scene.domain.low[2] = ground_level(world, scene.domain);
  scene.domain.high[2] += std::clamp(0.05 * scene.domain.size()[2], 2.0, 5.0);
  scene.voxel = scene.clearance = nice_number(longest / 200.0);
  scene.eta = 0.2 * scene.voxel;
  scene.start = find_start(world, scene.domain, {scene.clearance, scene.range});
}

}  // namespace

double nice_number(double value) {
  constexpr std::array<double, 10> kSeries{1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
  double up = 1.0, down = 1.0;  // Powers of ten, multiplied or divided once: 0.15 comes out as 0.15.
  while (value * down < 1.0) down *= 10.0;
  while (value >= 10.0 * up) up *= 10.0;
  const double mantissa = value * down / up;
  const auto ratio = [&](double x) { return std::max(x / mantissa, mantissa / x); };
  return *std::min_element(kSeries.begin(), kSeries.end(), [&](double a, double b) { return ratio(a) < ratio(b); }) * up / down;
}

AnyScene load_scene_file(const fs::path& spec, const SceneFileOptions& options) {
  const std::vector<fs::path> paths = split(spec);
  const std::string name = name_of(paths.front());
  const bool ground = options.ground > -kInfinity;
  require(!ground || paths.size() > 1 || !is_map_file(spec), "scene.ground: a plane map has no ground", spec.string());
  if (paths.size() == 1 && is_map_file(spec)) return map_scene(read_occupancy_map(spec, options.unit), name, spec.string());
  Scene<3> scene;
  scene.name = name;
  for (const fs::path& path : paths) {
    require(is_mesh_file(path), fmt::format("not a scene file: its name must end in {}, or .yaml, .png, .pgm alone", mesh_extensions()),
            path.string());
    append(scene, read_mesh(path, mesh_options(options)), name_of(path));
  }
  if (ground) add_ground(scene, options.ground);
  furnish(scene);
  return scene;
}

}  // namespace vantage
