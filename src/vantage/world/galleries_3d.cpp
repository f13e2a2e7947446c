// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "vantage/base/random.h"
#include "vantage/world/blocks.h"
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"

namespace vantage {
namespace {

// The mine is carved in whole metres and then made rough; lengths are in metres.
constexpr int kPillar = 7, kGallery = 3, kPitch = kPillar + kGallery;
constexpr int kMargin = 8;  ///< Rock round the outer galleries, into which blind headings go.
constexpr int kHeight = 3;

/// Place of the galleries and pillars: pillar (i, j) stands between the junctions (i, j) and (i + 1, j + 1).
struct Mine {
  int columns, rows;  ///< Pillars.

  [[nodiscard]] Vec<2> size() const { return {2.0 * kMargin + columns * kPitch + kGallery, 2.0 * kMargin + rows * kPitch + kGallery}; }
  [[nodiscard]] Vec<2> corner(int i, int j) const { return {kMargin + kGallery + i * kPitch, kMargin + kGallery + j * kPitch}; }
  [[nodiscard]] Vec<2> junction(int i, int j) const { return corner(i, j) - Vec<2>::Constant(0.5 * kGallery); }
  [[nodiscard]] int count() const { return (columns + 1) * (rows + 1); }
  [[nodiscard]] int node(int i, int j) const { return j * (columns + 1) + i; }
};

Box<3> upright(const Vec<2>& low, const Vec<2>& high) { return {Vec<3>(low[0], low[1], 0.0), Vec<3>(high[0], high[1], kHeight)}; }

double draw(Random& random, int count) { return static_cast<double>(random.below(static_cast<std::uint64_t>(count))); }

/// A pillar with sides and corners worked off here and there.
void add_pillar(Blocks<3>& rock, const Vec<2>& corner, Random& random) {
  const Vec<2> low = corner + Vec<2>{draw(random, 2), draw(random, 2)};
  const Vec<2> high = corner + Vec<2>{kPillar - draw(random, 2), kPillar - draw(random, 2)};
  rock.fill(upright(low, high));
  for (int k = 0; k < 4; ++k) {
    if (random.uniform() < 0.4) continue;
    const Vec<2> chip{1.0 + draw(random, 2), 1.0 + draw(random, 2)};
    Box<2> box{low, low + chip};
    for (int a = 0; a < 2; ++a)
      if (k & (1 << a)) box.low[a] = high[a] - chip[a], box.high[a] = high[a];
    rock.carve(upright(box.low, box.high));
  }
}

/// A stretch of gallery between two junctions.
struct Stretch {
  int i, j, axis;  ///< From junction (i, j) along an axis.
};

/// Rock across a stretch, from the pillar on one side to the pillar on the other, or to the outer rock.
void block_stretch(Blocks<3>& rock, const Mine& mine, const Stretch& stretch, Random& random) {
  const int thick = 1 + static_cast<int>(random.below(3)), across = 1 - stretch.axis;
  const double from = 2.0 + draw(random, 4 - thick);
  Vec<2> low = mine.corner(stretch.i, stretch.j), high = low;
  low[stretch.axis] += from;
  high[stretch.axis] += from + thick;
  low[across] -= kGallery + kPillar / 2;
  high[across] += kPillar / 2;
  rock.fill(upright(low, high));
}

/// All stretches in random order.
std::vector<Stretch> shuffled_stretches(const Mine& mine, Random& random) {
  std::vector<Stretch> all;
  for (int j = 0; j <= mine.rows; ++j)
    for (int i = 0; i <= mine.columns; ++i) {
      if (i < mine.columns) all.push_back({i, j, 0});
      if (j < mine.rows) all.push_back({i, j, 1});
    }
  for (std::size_t k = all.size(); k > 1; --k) std::swap(all[k - 1], all[random.below(k)]);
  return all;
}

/// Closes two in five of the stretches without which all junctions still hang together.
void block_some(Blocks<3>& rock, const Mine& mine, Random& random) {
  std::vector<int> group(static_cast<std::size_t>(mine.count()));
  std::iota(group.begin(), group.end(), 0);
  for (const Stretch& s : shuffled_stretches(mine, random)) {
    const int a = group[static_cast<std::size_t>(mine.node(s.i, s.j))];
    const int b = group[static_cast<std::size_t>(mine.node(s.i + (s.axis == 0 ? 1 : 0), s.j + (s.axis == 1 ? 1 : 0)))];
    if (a != b)
      std::replace(group.begin(), group.end(), b, a);
    else if (random.uniform() < 0.4)
      block_stretch(rock, mine, s, random);
  }
}

/// Blind headings that lead from the outer galleries into the rock, near the ends of the inner ones.
void carve_headings(Blocks<3>& rock, const Mine& mine, Random& random) {
  const std::array<int, 2> count{mine.columns, mine.rows};
  for (int axis = 0; axis < 2; ++axis)  // Along the side that runs along this axis.
    for (int k = 0; k <= count[static_cast<std::size_t>(axis)]; ++k)
      for (const bool high : {false, true}) {
        if (random.uniform() < 0.5) continue;
        const double along = mine.corner(k, k)[axis] - kGallery - 1 + draw(random, 3), edge = high ? mine.size()[1 - axis] - kMargin : kMargin;
        const double end = edge + (high ? 1.0 : -1.0) * (3.0 + draw(random, 4));
        Box<2> box;
        box.low[axis] = along;
        box.high[axis] = along + kGallery;
        box.low[1 - axis] = std::min(edge, end);
        box.high[1 - axis] = std::max(edge, end);
        rock.carve(upright(box.low, box.high));
      }
}

/// Cuts the solid into cubes of a metre: what it is stays, its faces get corners to move.
void subdivide(Blocks<3>& rock, const Box<3>& hull) {
  for (int a = 0; a < 3; ++a)
    for (double x = hull.low[a]; x < hull.high[a]; x += 1.0) {
      Box<3> slice = hull;
      slice.low[a] = x;
      slice.high[a] = x + 1.0;
      rock.fill(slice);
    }
}

/// Moves every corner: walls and roof by up to 0.3 m along each axis, the floor by half of it.
void roughen(Mesh<3>& mesh, Random& random) {
  constexpr double kRough = 0.3;
  for (Vec<3>& v : mesh.vertices) {
    const double rough = v[2] < 0.5 ? 0.5 * kRough : kRough;
    for (int a = 0; a < 3; ++a) v[a] += random.uniform(-rough, rough);
  }
}

}  // namespace

Scene<3> make_galleries(int columns, int rows, std::uint64_t seed) {
  const Mine mine{columns, rows};
  const Vec<2> size = mine.size(), start = mine.junction(columns / 2, rows / 2);
  const SceneSetting<3> setting{.name = "galleries",
                                .domain = {Vec<3>(0.0, 0.0, -0.6), Vec<3>(size[0], size[1], kHeight + 0.6)},
                                .start = Vec<3>(start[0], start[1], 1.5),
                                .voxel = 0.4,
                                .eta = 0.08,
                                .range = 60.0,
                                .clearance = 0.4};
  Random random(seed);
  Blocks<3> rock;
  subdivide(rock, {Vec<3>(-1.0, -1.0, -1.0), Vec<3>(size[0] + 1.0, size[1] + 1.0, kHeight + 1.0)});
  rock.carve(upright(Vec<2>::Constant(kMargin), size - Vec<2>::Constant(kMargin)));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) add_pillar(rock, mine.corner(i, j), random);
  block_some(rock, mine, random);
  carve_headings(rock, mine, random);
  Scenery<3> scenery;
  rock.append_to(scenery["rock"]);
  roughen(scenery["rock"], random);
  return scenery.scene(setting);
}

}  // namespace vantage
