// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/outdoors_3d.h"

#include "vantage/world/shapes_2d.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

constexpr double kRoot = -0.3;  // Depth below the ground [m].

Vec<3> over(const Vec<2>& foot, double z) { return {foot[0], foot[1], z}; }

Ring ring_of(const Placement<3>& place, double x0, double x1, double half_width, double z) {
  return rectangle(place, {Vec<2>(x0, -half_width), Vec<2>(x1, half_width)}, z);
}

Box<3> block(double x0, double x1, double y0, double y1, double z0, double z1) { return {Vec<3>(x0, y0, z0), Vec<3>(x1, y1, z1)}; }

}  // namespace

void add_tree(Scenery<3>& scenery, const Vec<2>& foot, double height, Random& random) {
  Mesh<3>& mesh = scenery["tree"];
  const Vec<3> up = Vec<3>::UnitZ();
  add_loft(mesh, {circle(over(foot, kRoot), up, 0.035 * height, 7), circle(over(foot, 0.6 * height), up, 0.02 * height, 7)});
  const double turn = random.uniform(0.0, 2.0 * kPi);
  constexpr int kClumps = 4;
  for (int i = 0; i < kClumps; ++i) {  // One on top, the others around below it.
    const auto [s, c] = sin_cos(turn + i * (2.0 * kPi / (kClumps - 1)));
    const double away = i == 0 ? 0.0 : 0.13 * height, z = (i == 0 ? 0.78 : random.uniform(0.52, 0.64)) * height;
    const double size = random.uniform(0.15, 0.19) * height;
    add_ball(mesh, over(foot, z) + Vec<3>(away * c, away * s, 0.0), {size, size, 0.95 * size}, 0.15, random);
  }
}

void add_fir(Scenery<3>& scenery, const Vec<2>& foot, double height, Random& random) {
  Mesh<3>& mesh = scenery["tree"];
  add_cylinder(mesh, over(foot, kRoot), over(foot, 0.3 * height), 0.02 * height, 7);
  const double width = random.uniform(0.16, 0.21) * height;
  for (int i = 0; i < 3; ++i) {
    const double low = (0.16 + 0.22 * i) * height, high = (i == 2 ? 1.0 : 0.16 + 0.22 * i + 0.42) * height;
    add_cone(mesh, over(foot, low), over(foot, high), width * (1.0 - 0.24 * i), 9);
  }
}

void add_grove(Scenery<3>& scenery, const Box<2>& area, int count, Random& random) {
  const Disc nowhere{Vec<2>::Constant(1e6), 0.0};
  for (const Disc& crown : scatter_discs(area, count, {1.2, 1.7}, 0.8, nowhere, random)) {
    const double height = crown.radius * random.uniform(3.6, 4.6);
    if (random.uniform() < 0.6)
      add_tree(scenery, crown.center, height, random);
    else
      add_fir(scenery, crown.center, 1.3 * height, random);
  }
}

void add_car(Scenery<3>& scenery, const Placement<3>& place, Random& random) {
  Mesh<3>& mesh = scenery["vehicle"];
  const double scale = random.uniform(0.94, 1.06), back = random.uniform(-1.9, -1.5);
  const auto x = [&](double along) { return scale * along; };
  add_loft(mesh,
           {ring_of(place, x(-2.1), x(2.1), 0.86, 0.0), ring_of(place, x(-2.15), x(2.15), 0.9, 0.55), ring_of(place, x(-2.1), x(2.0), 0.84, 0.9)});
  add_loft(mesh, {ring_of(place, x(back), x(1.0), 0.82, 0.85), ring_of(place, x(back + 0.45), x(0.3), 0.66, 1.45)});
}

void add_lorry(Scenery<3>& scenery, const Placement<3>& place) {
  Mesh<3>& mesh = scenery["vehicle"];
  add_box(mesh, place, block(-3.7, 3.4, -1.0, 1.0, 0.0, 0.95));
  add_box(mesh, place, block(-3.7, 1.6, -1.2, 1.2, 0.9, 3.1));
  add_loft(mesh, {ring_of(place, 1.8, 3.7, 1.15, 0.5), ring_of(place, 1.8, 3.7, 1.15, 1.6), ring_of(place, 1.8, 3.2, 1.05, 2.5)});
}

void add_power_line(Scenery<3>& scenery, std::span<const Vec<2>> feet) {
  constexpr double kHeight = 7.5, kReach = 0.7;
  const std::array<double, 3> radii{0.010, 0.015, 0.020};
  std::vector<std::array<Vec<3>, 3>> hooks;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const Vec<2> before = feet[i == 0 ? 0 : i - 1], after = feet[i + 1 < feet.size() ? i + 1 : i];
    const Vec<2> along = (after - before).normalized();
    const Placement<3> place{over(feet[i], 0.0), along[0], along[1]};
    add_cylinder(scenery["pole"], place({0.0, 0.0, kRoot}), place({0.0, 0.0, kHeight}), 0.12, 8);
    add_box(scenery["pole"], place, block(-0.05, 0.05, -kReach - 0.1, kReach + 0.1, kHeight - 0.55, kHeight - 0.43));
    add_box(scenery["pole"], place, block(-0.06, 0.06, 0.05, 1.4, 5.6, 5.72));  // Arm
    add_box(scenery["pole"], place, block(-0.12, 0.12, 1.1, 1.7, 5.45, 5.65));  // and lamp.
    hooks.push_back({place({0.0, -kReach, kHeight - 0.42}), place({0.0, 0.0, kHeight + 0.01}), place({0.0, kReach, kHeight - 0.42})});
  }
  for (std::size_t i = 0; i + 1 < hooks.size(); ++i)
    for (std::size_t k = 0; k < radii.size(); ++k) {
      const double span = (hooks[i + 1][k] - hooks[i][k]).norm();
      add_wire(scenery["wire"], hooks[i][k], hooks[i + 1][k], 0.025 * span, radii[k]);
    }
}

void add_table(Scenery<3>& scenery, const Placement<3>& place) {
  Mesh<3>& mesh = scenery["furniture"];
  add_box(mesh, place, block(-0.9, 0.9, -0.4, 0.4, 0.70, 0.78));
  for (const double x : {-0.7, 0.7}) add_box(mesh, place, block(x - 0.05, x + 0.05, -0.3, 0.3, -0.1, 0.72));
  for (const double y : {-0.8, 0.8}) add_bench(scenery, place.at({0.0, y, 0.0}));
}

void add_bench(Scenery<3>& scenery, const Placement<3>& place) {
  Mesh<3>& mesh = scenery["furniture"];
  add_box(mesh, place, block(-0.8, 0.8, -0.17, 0.17, 0.40, 0.46));
  for (const double x : {-0.65, 0.65}) add_box(mesh, place, block(x - 0.04, x + 0.04, -0.13, 0.13, -0.1, 0.42));
}

void add_fountain(Scenery<3>& scenery, const Vec<2>& center) {
  Mesh<3>& mesh = scenery["column"];
  const Vec<3> up = Vec<3>::UnitZ();
  add_cylinder(mesh, over(center, kRoot), over(center, 0.35), 2.2, 16);
  add_loft(mesh, {circle(over(center, 0.3), up, 0.45, 10), circle(over(center, 2.6), up, 0.3, 10), circle(over(center, 2.9), up, 0.6, 10)});
}

}  // namespace vantage
