// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "vantage/world/blocks.h"
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"
#include "vantage/world/shapes_3d.h"
#include "vantage/world/storey_plan.h"

namespace vantage {
namespace {

constexpr double kHeight = 2.8, kDoorHeight = 2.1, kSlab = 0.3;  // [m]
constexpr double kBite = 0.05;                                   // Overlap of solids that stand on each other [m].
constexpr double kAisle = 1.2;                                   // Left free between pieces of furniture and before doors [m].

Box<3> upright(const Box<2>& base, double low, double high) {
  return {Vec<3>(base.low[0], base.low[1], low), Vec<3>(base.high[0], base.high[1], high)};
}

/// A sort of furniture.
struct Piece {
  Vec<2> size;    ///< Along the wall, away from it [m].
  double height;  ///< [m]
  bool at_wall;   ///< Else it stands free.
  bool on_legs;
};

/// `piece` somewhere in the room, along a random wall or free of all walls.
Box<2> draw_place(const Box<2>& room, const Piece& piece, Random& random) {
  const int axis = static_cast<int>(random.below(2));
  Vec<2> size = piece.size;
  if (axis == 1) std::swap(size[0], size[1]);
  Box<2> box;
  for (int a = 0; a < 2; ++a) {
    const double margin = piece.at_wall ? 0.0 : kAisle, slack = room.size()[a] - size[a] - 2.0 * margin;
    const bool against = piece.at_wall && a != axis;
    const double share = against ? static_cast<double>(random.below(2)) : random.uniform();
    box.low[a] = room.low[a] + margin + share * slack + (against ? (share > 0.5 ? kBite : -kBite) : 0.0);
    box.high[a] = box.low[a] + size[a];
  }
  return box;
}

void add_piece(Scenery<3>& scenery, const Box<2>& base, const Piece& piece) {
  Mesh<3>& mesh = scenery["furniture"];
  if (!piece.on_legs) return add_box(mesh, {}, upright(base, -kBite, piece.height));
  add_box(mesh, {}, upright(base, piece.height - 0.06, piece.height));
  for (const Vec<2>& at : {base.low, base.high, Vec<2>(base.low[0], base.high[1]), Vec<2>(base.high[0], base.low[1])}) {
    const Vec<2> foot = at + 0.12 * (base.center() - at).cwiseSign();
    add_box(mesh, {}, upright({foot.array() - 0.04, foot.array() + 0.04}, -kBite, piece.height - 0.03));
  }
}

/// Pieces that leave the doors and a way round each other free.
void furnish(Scenery<3>& scenery, const Box<2>& room, const std::vector<Box<2>>& doors, Random& random) {
  if (random.uniform() < 0.15) return;
  const std::array<Piece, 6> sorts{Piece{{1.6, 0.8}, 0.75, true, false}, {{1.2, 0.5}, 2.0, true, false},  {{2.4, 0.45}, 1.9, true, false},
                                   {{1.8, 0.9}, 0.75, false, true},      {{2.6, 0.5}, 2.0, false, false}, {{0.7, 0.7}, 1.1, false, false}};
  const std::size_t liked = random.below(sorts.size());
  std::vector<Box<2>> placed;
  const auto tries = static_cast<int>(room.size().prod() / 3.0);
  for (int i = 0; i < tries; ++i) {
    const Piece& piece = sorts[random.uniform() < 0.6 ? liked : random.below(sorts.size())];
    const Box<2> base = draw_place(room, piece, random);
    const auto meets = [&](const Box<2>& other) { return !other.grown(kAisle).intersection(base).empty(); };
    const bool fits = room.grown(2.0 * kBite).contains(base.low) && room.grown(2.0 * kBite).contains(base.high);
    if (!fits || std::any_of(doors.begin(), doors.end(), meets) || std::any_of(placed.begin(), placed.end(), meets)) continue;
    add_piece(scenery, base, piece);
    placed.push_back(base);
  }
}

/// The walls between a floor and a ceiling; all three reach out of the domain, so that nothing outside is to be explored.
void add_storey(Scenery<3>& scenery, const StoreyPlan& plan, const Box<2>& outer) {
  Blocks<3> walls;
  walls.fill(upright(outer, -kBite, kHeight + kBite));
  for (const auto* spaces : {&plan.rooms, &plan.corridors})
    for (const Box<2>& space : *spaces) walls.carve(upright(space, -kBite, kHeight + kBite));
  for (const Box<2>& door : plan.doors) walls.carve(upright(door, -kBite, kDoorHeight));
  walls.append_to(scenery["wall"]);
  add_box(scenery["slab"], {}, upright(outer.grown(0.1), -kSlab, 0.0));
  add_box(scenery["slab"], {}, upright(outer.grown(0.1), kHeight, kHeight + kSlab));
}

}  // namespace

Scene<3> make_floor(int rooms, std::uint64_t seed) {
  constexpr double kPerRoom = 37.5, kAspect = 1.5, kOuterWall = 0.4;  // Area with its share of the corridors [m2].
  const Vec<2> size(std::sqrt(rooms * kPerRoom * kAspect), std::sqrt(rooms * kPerRoom / kAspect));
  const Box<2> outer{Vec<2>::Zero(), size};
  Random random(seed);
  const StoreyPlan plan = plan_storey(outer.grown(-kOuterWall), {.rooms = rooms}, random);
  const Vec<2> start = (plan.corridors.empty() ? plan.rooms : plan.corridors)[0].center();
  const SceneSetting<3> setting{.name = "floor",
                                .domain = upright(outer, -kSlab, kHeight + kSlab),
                                .start = Vec<3>(start[0], start[1], 1.5),
                                .voxel = 0.3,
                                .eta = 0.05,
                                .range = 60.0,
                                .clearance = 0.35};
  Scenery<3> scenery;
  add_storey(scenery, plan, outer.grown(0.5));
  for (std::size_t i = plan.corridors.empty() ? 1 : 0; i < plan.rooms.size(); ++i) furnish(scenery, plan.rooms[i], plan.doors, random);
  return scenery.scene(setting);
}

}  // namespace vantage
