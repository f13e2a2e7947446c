// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/geometry/patch.h"
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

struct Pipe {
  Vec<3> from, to;
  double radius;
};

/// Upright pipes evenly on a circle about the middle.
std::vector<Pipe> ring_of_pipes(const Box<3>& domain, int count) {
  constexpr double kRing = 6.0;
  std::vector<Pipe> pipes;
  for (int i = 0; i < count; ++i) {
    const auto [s, c] = sin_cos((i + 0.5) * (2.0 * kPi / count));
    const Vec<3> foot(domain.center()[0] + kRing * c, domain.center()[1] + kRing * s, domain.low[2] + 1.0);
    pipes.push_back({foot, foot + 8.0 * Vec<3>::UnitZ(), std::min(1.0, 0.2 * 2.0 * kPi * kRing / count)});
  }
  return pipes;
}

/// A pipe along a random axis, `length` long, `radius` or more inside the domain.
Pipe random_pipe(const Box<3>& domain, double radius, Random& random) {
  const auto axis = static_cast<int>(random.below(3));
  const double length = random.uniform(0.6, 0.8) * domain.size()[axis];
  Vec<3> from;
  for (int a = 0; a < 3; ++a) {
    const double margin = a == axis ? 1.0 : radius + 1.0;
    from[a] = random.uniform(domain.low[a] + margin, domain.high[a] - margin - (a == axis ? length : 0.0));
  }
  return {from, from + length * Vec<3>::Unit(axis), radius};
}

/// Pipes at least `gap` apart and from `keep_free`; one that finds no place gets thinner until it does.
std::vector<Pipe> scattered_pipes(const Box<3>& domain, int count, const Vec<3>& keep_free, Random& random) {
  constexpr double kGap = 1.2;
  std::vector<Pipe> pipes;
  const auto fits = [&](const Pipe& pipe) {
    const auto axis = segment_patch<3>(pipe.from, pipe.to);
    return distance(axis, keep_free) >= pipe.radius + kGap && std::all_of(pipes.begin(), pipes.end(), [&](const Pipe& other) {
             return distance_to_segment(axis, other.from, other.to) >= pipe.radius + other.radius + kGap;
           });
  };
  while (static_cast<int>(pipes.size()) < count) {
    double radius = random.uniform(0.5, 1.2);
    Pipe pipe = random_pipe(domain, radius, random);
    while (!fits(pipe)) pipe = random_pipe(domain, radius *= 0.998, random);
    pipes.push_back(pipe);
  }
  return pipes;
}

}  // namespace

Scene<3> make_pipes(int cylinders, bool symmetric, std::uint64_t seed) {
  const SceneSetting<3> setting{.name = "pipes",
                                .domain = {Vec<3>(0.0, 0.0, 0.0), Vec<3>(20.0, 20.0, 10.0)},
                                .start = Vec<3>(2.0, 2.0, 5.0),
                                .voxel = 1.0 / 3.0,
                                .eta = 0.05,
                                .range = 40.0,
                                .clearance = 0.5};
  Random random(seed);
  Scenery<3> scenery;
  for (const Pipe& pipe : symmetric ? ring_of_pipes(setting.domain, cylinders) : scattered_pipes(setting.domain, cylinders, setting.start, random))
    add_cylinder(scenery["pipe"], pipe.from, pipe.to, pipe.radius, 24);
  return scenery.scene(setting);
}

}  // namespace vantage
