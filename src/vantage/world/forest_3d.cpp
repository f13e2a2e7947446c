// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"
#include "vantage/world/shapes_2d.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

constexpr double kBumps = 0.15;  // Of crowns, bushes and boulders, by their radius.
const Vec<3> kUp = Vec<3>::UnitZ();

/// Gently rolling ground, nowhere above z = 0.
class Terrain {
 public:
  explicit Terrain(Random& random) {
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      const auto [s, c] = sin_cos(random.uniform(0.0, 2.0 * kPi));
      const double length = 34.0 / static_cast<double>(1 + i);  // The longer, the higher.
      waves_[i] = {2.0 * kPi / length * Vec<2>(c, s), random.uniform(0.0, 2.0 * kPi), 0.02 * length};
    }
  }
  [[nodiscard]] double height(const Vec<2>& at) const {
    double z = 0.0;
    for (const Wave& wave : waves_) z += wave.amplitude * (sin_cos(wave.number.dot(at) + wave.phase)[0] - 1.0);
    return z;
  }

 private:
  struct Wave {
    Vec<2> number;  ///< [rad/m]
    double phase, amplitude;
  };
  std::array<Wave, 3> waves_;
};

Vec<3> over(const Vec<3>& foot, double z) { return foot + z * kUp; }

/// Trunk, leaning a little, from below the ground.
void add_trunk(Mesh<3>& mesh, const Vec<3>& foot, const Vec<3>& top, double radius) {
  add_loft(mesh, {circle(over(foot, -0.4), kUp, 1.1 * radius, 8), circle(top, kUp, 0.6 * radius, 8)});
}

/// Trunk under one round crown.
void add_broad_tree(Scenery<3>& scenery, const Vec<3>& foot, double crown, Random& random) {
  const double tall = crown * random.uniform(0.8, 1.3), middle = random.uniform(2.4, 3.6) + tall;
  const Vec<3> top = over(foot, middle) + Vec<3>{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.0};
  add_trunk(scenery["trunk"], foot, top, 0.1 * crown + random.uniform(0.05, 0.1));
  add_ball(scenery["crown"], top, {crown, crown, tall}, kBumps, random);
}

/// Trunk in a tall crown of three skirts, one solid.
void add_spruce(Scenery<3>& scenery, const Vec<3>& foot, double crown, Random& random) {
  const double low = random.uniform(1.0, 2.2), high = low + crown * random.uniform(3.0, 3.6), step = (high - low) / 3.0;
  add_trunk(scenery["trunk"], foot, over(foot, low + step), 0.08 * crown + 0.06);
  std::vector<Ring> rings;
  for (int i = 0; i < 3; ++i) {
    const double width = crown * (1.0 - 0.27 * i);
    rings.push_back(circle(over(foot, low + i * step), kUp, width, 9));
    if (i < 2) rings.push_back(circle(over(foot, low + (i + 0.85) * step), kUp, 0.5 * width, 9));
  }
  rings.push_back({over(foot, high)});
  add_loft(scenery["crown"], rings);
}

/// A dead trunk, broken off.
void add_snag(Scenery<3>& scenery, const Vec<3>& foot, Random& random) {
  const double height = random.uniform(2.5, 6.0);
  add_trunk(scenery["trunk"], foot, over(foot, height), random.uniform(0.2, 0.35));
}

/// Bushes, boulders and stumps between the trees where there is room.
void add_undergrowth(Scenery<3>& scenery, const Box<2>& area, std::vector<Disc> taken, const Terrain& terrain, Random& random) {
  constexpr double kGap = 0.5;
  for (std::size_t wanted = taken.size() / 2; wanted > 0; --wanted) {
    const Disc spot{{random.uniform(area.low[0], area.high[0]), random.uniform(area.low[1], area.high[1])}, random.uniform(0.4, 0.9)};
    const auto apart = [&](const Disc& other) { return (other.center - spot.center).norm() >= other.radius + spot.radius + kGap; };
    const double sort = random.uniform();
    if (!std::all_of(taken.begin(), taken.end(), apart)) continue;
    const Vec<3> foot(spot.center[0], spot.center[1], terrain.height(spot.center));
    const double r = spot.radius / (1.0 + kBumps);
    if (sort < 0.5)
      add_ball(scenery["bush"], over(foot, 0.5 * r), {r, r, 1.1 * r}, kBumps, random);
    else if (sort < 0.8)
      add_ball(scenery["boulder"], foot, {r, r, 0.8 * r}, kBumps, random);
    else
      add_cylinder(scenery["trunk"], over(foot, -0.3), over(foot, 0.6), 0.5 * r, 9);
    taken.push_back(spot);
  }
}

/// Ground that follows the terrain, as an open sheet.
void add_terrain(Scenery<3>& scenery, const Box<2>& area, const Terrain& terrain) {
  Mesh<3>& ground = scenery["ground"];
  add_ground(ground, area, 0.0, 1.0);
  for (Vec<3>& v : ground.vertices) v[2] = terrain.height(v.head<2>());
}

}  // namespace

Scene<3> make_forest(int trees, std::uint64_t seed) {
  const SceneSetting<3> setting{.name = "forest",
                                .domain = {Vec<3>(0.0, 0.0, -3.0), Vec<3>(48.0, 36.0, 13.0)},
                                .start = Vec<3>(4.0, 4.0, 1.5),
                                .voxel = 0.5,
                                .eta = 0.1,
                                .range = 60.0,
                                .clearance = 0.5};
  Random random(seed);
  const Terrain terrain(random);
  const Box<2> area = Box<2>{setting.domain.low.head<2>(), setting.domain.high.head<2>()}.grown(-0.3);
  Scenery<3> scenery;
  add_terrain(scenery, area.grown(12.0), terrain);
  const std::vector<Disc> crowns = scatter_discs(area, trees, {1.3, 2.9}, 0.25, {setting.start.head<2>(), 1.2}, random);
  for (const Disc& crown : crowns) {
    const Vec<3> foot(crown.center[0], crown.center[1], terrain.height(crown.center));
    const double radius = crown.radius / (1.0 + kBumps), sort = random.uniform();
    if (sort < 0.5)
      add_broad_tree(scenery, foot, radius, random);
    else if (sort < 0.9)
      add_spruce(scenery, foot, radius, random);
    else
      add_snag(scenery, foot, random);
  }
  add_undergrowth(scenery, area.grown(-0.9), crowns, terrain, random);
  return scenery.scene(setting);
}

}  // namespace vantage
