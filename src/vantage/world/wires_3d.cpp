// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

constexpr double kRoot = -0.3;  // Depth below the ground [m].

/// A point of the ground plan at a height [m].
Vec<3> over(const Vec<2>& foot, double z) { return {foot[0], foot[1], z}; }

Vec<2> heading(double angle) {
  const auto [s, c] = sin_cos(angle);
  return {c, s};
}

/// Poles of 7.5 m and from each to the next four wires, one to three times `radius` thick.
void add_line(Scenery<3>& scenery, std::span<const Vec<2>> feet, double radius) {
  constexpr double kHeight = 7.5;
  for (const Vec<2>& foot : feet) {
    add_cylinder(scenery["pole"], over(foot, kRoot), over(foot, kHeight), 0.1, 10);
    add_box(scenery["pole"], {over(foot, 0.0)}, {Vec<3>(-0.05, -1.0, kHeight - 0.55), Vec<3>(0.05, 1.0, kHeight - 0.43)});  // Cross-arm.
  }
  const Vec<3> hooks[] = {{0.0, -0.9, -0.42}, {0.0, 0.0, 0.01}, {0.0, 0.9, -0.42}, {0.0, 0.0, -1.0}};
  const double thickness[] = {1.0, 1.5, 2.0, 3.0};
  for (std::size_t i = 0; i + 1 < feet.size(); ++i)
    for (int k = 0; k < 4; ++k)
      add_wire(scenery["wire"], over(feet[i], kHeight) + hooks[k], over(feet[i + 1], kHeight) + hooks[k], 0.02 * (feet[i + 1] - feet[i]).norm(),
               thickness[k] * radius);
}

/// Posts of 4 cm, each with a rod of `radius` on its top and a taut wire from there to the ground, in a direction of its own.
void add_guyed_posts(Scenery<3>& scenery, int count, double radius, Random& random) {
  for (int i = 0; i < count; ++i) {
    const Vec<2> foot(7.0 + (i + random.uniform(0.3, 0.7)) * 26.0 / count, random.uniform(12.0, 16.0));
    const double height = random.uniform(2.0, 4.0);
    add_cylinder(scenery["pole"], over(foot, kRoot), over(foot, height), 0.02, 8);
    add_cylinder(scenery["wire"], over(foot, height - 0.05), over(foot, height + random.uniform(1.0, 2.5)), radius, 6);
    const Vec<2> anchor = foot + random.uniform(0.4, 1.6) * height * heading(random.uniform(0.0, 2.0 * kPi));
    add_cylinder(scenery["wire"], over(foot, height), over(anchor, kRoot), radius, 6);
  }
}

/// Posts every 2 m, two rails and a bar of 12 mm every 15 cm.
void add_fence(Scenery<3>& scenery, const Vec<2>& from, const Vec<2>& to) {
  Mesh<3>& mesh = scenery["fence"];
  const double length = (to - from).norm();
  const auto at = [&](double along) -> Vec<2> { return from + along / length * (to - from); };
  for (double s = 0.0; s <= length; s += 2.0) add_cylinder(mesh, over(at(s), kRoot), over(at(s), 1.5), 0.03, 8);
  for (double s = 0.15; s < length; s += 0.15) add_cylinder(mesh, over(at(s), 0.1), over(at(s), 1.4), 0.006, 6);
  for (const double z : {0.2, 1.3}) add_cylinder(mesh, over(from, z), over(to, z), 0.015, 6);
}

/// Hand rail of 42 mm at 1 m, a bar at half the height, and posts every metre.
void add_railing(Scenery<3>& scenery, const Vec<2>& from, const Vec<2>& to) {
  Mesh<3>& mesh = scenery["railing"];
  const double length = (to - from).norm();
  add_cylinder(mesh, over(from, 1.0), over(to, 1.0), 0.021, 8);
  add_cylinder(mesh, over(from, 0.5), over(to, 0.5), 0.012, 8);
  for (double s = 0.0; s <= length; s += 1.0) {
    const Vec<2> foot = from + s / length * (to - from);
    add_cylinder(mesh, over(foot, kRoot), over(foot, 1.0), 0.015, 8);
  }
}

/// Mast of four legs with rings and crossed braces every metre, 0.8 m wide at its foot and 10 m high, and three wires that hold it.
void add_tower(Scenery<3>& scenery, const Vec<2>& foot, double turn, double radius) {
  constexpr double kHeight = 10.0;
  Mesh<3>& mesh = scenery["tower"];
  const auto corner = [&](int leg, double z) -> Vec<3> {
    return over(foot + (0.4 - 0.02 * z) * std::sqrt(2.0) * heading(turn + (leg + 0.5) * 0.5 * kPi), z);
  };
  for (int leg = 0; leg < 4; ++leg) {
    add_cylinder(mesh, corner(leg, kRoot), corner(leg, kHeight), 0.03, 8);
    for (double z = 0.0; z < kHeight; z += 1.0) {
      add_cylinder(mesh, corner(leg, z + 1.0), corner(leg + 1, z + 1.0), 0.012, 6);
      add_cylinder(mesh, corner(leg, z), corner(leg + 1, z + 1.0), 0.008, 6);
      add_cylinder(mesh, corner(leg + 1, z), corner(leg, z + 1.0), 0.008, 6);
    }
  }
  for (int k = 0; k < 3; ++k)
    add_cylinder(scenery["wire"], over(foot, kHeight), over(foot + 6.0 * heading(turn + k * 2.0 * kPi / 3.0), kRoot), radius, 6);
}

}  // namespace

Scene<3> make_wires(int posts, double diameter, std::uint64_t seed) {
  const SceneSetting<3> setting{.name = "wires",
                                .domain = {Vec<3>(0.0, 0.0, -0.5), Vec<3>(40.0, 30.0, 12.0)},
                                .start = Vec<3>(20.0, 4.0, 1.6),
                                .voxel = 0.5,
                                .eta = 0.1,
                                .range = 60.0,
                                .clearance = 0.4};
  Random random(seed);
  Scenery<3> scenery;
  const auto near = [&](double x, double y) -> Vec<2> { return {x + random.uniform(-0.5, 0.5), y + random.uniform(-0.5, 0.5)}; };
  add_ground(scenery["ground"], {Vec<2>(-10.0, -10.0), Vec<2>(50.0, 40.0)}, 0.0, 5.0);
  add_line(scenery, std::vector<Vec<2>>{near(3.0, 26.0), near(14.0, 25.0), near(25.0, 25.5), near(37.0, 26.0)}, 0.5 * diameter);
  add_guyed_posts(scenery, posts, 0.5 * diameter, random);
  add_fence(scenery, near(4.0, 8.5), near(15.0, 7.0));
  add_railing(scenery, near(25.0, 6.5), near(35.0, 9.0));
  add_tower(scenery, near(20.0, 20.5), random.uniform(0.0, 2.0 * kPi), 0.5 * diameter);
  return scenery.scene(setting);
}

}  // namespace vantage
