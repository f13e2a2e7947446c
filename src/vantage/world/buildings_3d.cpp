// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/buildings_3d.h"

#include <algorithm>

#include "vantage/world/blocks.h"
#include "vantage/world/floor_plan.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

constexpr double kFooting = -0.3;    // Depth below the ground [m].
constexpr double kFloor = 0.1;       // Of the lowest storey, above the ground [m].
constexpr double kStorey = 3.0;      // Floor to floor [m].
constexpr double kSlab = 0.3;        // Thickness of a floor [m].
constexpr double kBite = 0.05;       // Overlap of solids that stand on each other, so that no two faces coincide [m].
constexpr double kOverhang = 0.4;    // Of a roof [m].
constexpr double kDoorHeight = 2.2;  // [m]
constexpr double kQuarter = 0.5 * kPi;

Box<3> upright(const Box<2>& base, double low, double high) {
  return {Vec<3>(base.low[0], base.low[1], low), Vec<3>(base.high[0], base.high[1], high)};
}

Box<2> flat(double x0, double x1, double y0, double y1) { return {Vec<2>(x0, y0), Vec<2>(x1, y1)}; }

Box<3> solid(double x0, double x1, double y0, double y1, double z0, double z1) { return upright(flat(x0, x1, y0, y1), z0, z1); }

bool overlap(const Box<2>& a, const Box<2>& b) { return !a.intersection(b).empty(); }

/// A flight of stairs: the hole in the floor above, and the slope in it from `foot` to `head` (their x or y differ).
struct Stair {
  Box<2> hole;
  Box<2> flight;
  int axis;      ///< Along which it rises.
  bool upwards;  ///< Towards the high end of that axis.
};

/// A stair in a corner of the largest room, along one of its walls and clear of all doors.
Stair place_stair(const FloorPlan& plan, const std::vector<Box<2>>& doors) {
  constexpr double kLength = 3.0, kWidth = 2.2, kFlight = 0.9, kDoorRoom = 1.0;
  const Box<2> room =
      *std::max_element(plan.rooms.begin(), plan.rooms.end(), [](const Box<2>& a, const Box<2>& b) { return a.size().prod() < b.size().prod(); });
  Stair stair{};
  for (int corner = 0; corner < 8; ++corner) {
    const int axis = corner & 1;
    const auto along_wall = [&](double width) {
      Box<2> box = room;
      Vec<2> size = Vec<2>::Constant(width).cwiseMin(room.size());
      size[axis] = std::min(kLength, room.size()[axis]);
      for (int a = 0; a < 2; ++a) (corner & (2 << a) ? box.low[a] : box.high[a]) = corner & (2 << a) ? box.high[a] - size[a] : box.low[a] + size[a];
      return box;
    };
    stair = {along_wall(kWidth), along_wall(kFlight), axis, (corner & (2 << axis)) != 0};
    if (std::none_of(doors.begin(), doors.end(), [&](const Box<2>& door) { return overlap(door.grown(kDoorRoom), stair.flight); })) break;
  }
  return stair;
}

/// The sloping slab of a stair between two floors.
void add_flight(Mesh<3>& mesh, const Placement<3>& place, const Stair& stair, double floor) {
  constexpr double kThick = 0.25;
  const Box<2> base = stair.flight.grown(kBite);
  const Ring corners = rectangle(place, base, 0.0);  // Counterclockwise from the low corner.
  const auto lifted = [&](double lift) {
    Ring ring = corners;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool far_end = stair.axis == 0 ? (i == 1 || i == 2) : (i >= 2);
      ring[i][2] += lift + (far_end == stair.upwards ? floor + kStorey - kBite : floor);
    }
    return ring;
  };
  add_loft(mesh, {lifted(-kThick), lifted(0.0)});
}

/// `openings`: windows, seen from above.
void carve_storey(Blocks<3>& body, const FloorPlan& plan, std::span<const Box<2>> openings, double floor) {
  constexpr double kSill = 0.85, kLintel = 2.2;
  for (const Box<2>& room : plan.rooms) body.carve(upright(room, floor, floor + kStorey - kSlab));
  for (const Box<2>& door : plan.doors) body.carve(upright(door, floor, floor + kDoorHeight));
  for (const Box<2>& window : openings) body.carve(upright(window, floor + kSill, floor + kLintel));
}

/// Opening from the house to the annex on its right.
Box<2> annex_door(const FloorPlan& plan, const FloorPlanOptions& options) {
  const auto room = std::find_if(plan.rooms.begin(), plan.rooms.end(), [&](const Box<2>& r) { return r.high[0] >= plan.inside.high[0] - 1e-9; });
  const double x = plan.inside.high[0], y = room->center()[1];
  return flat(x, x + options.wall, y - 0.5 * options.door, y + 0.5 * options.door);
}

/// Room beside the house that has a door of its own to the front.
void add_annex(Blocks<3>& body, const House& house, double middle, const FloorPlanOptions& options) {
  constexpr double kHeight = 2.7, kDepth = 5.0;
  const double x = house.width, back = std::min(house.depth, std::max(middle + 0.5 * kDepth, kDepth)), front = back - kDepth;
  const double door = x + 0.5 * (kAnnexWidth - options.wall - options.door);
  body.fill(solid(x, x + kAnnexWidth, front, back, kFooting, kHeight + kSlab));
  body.carve(solid(x, x + kAnnexWidth - options.wall, front + options.wall, back - options.wall, kFloor, kHeight));
  body.carve(solid(door, door + options.door, front, front + options.wall, kFloor, kFloor + kDoorHeight));
}

void add_roof(Scenery<3>& scenery, const Placement<3>& place, const House& house, double top) {
  constexpr double kPitch = 0.62;  // Rise over run.
  const Box<2> base = flat(0.0, house.width, 0.0, house.depth).grown(kOverhang);
  Mesh<3>& roof = scenery["roof"];
  const double z = top - kBite;
  switch (house.roof) {
    case House::Roof::flat: return;
    case House::Roof::gable: return add_gable_roof(roof, place, base, z, kPitch * 0.5 * base.size()[1]);
    case House::Roof::hip: return add_hip_roof(roof, place, base, z, kPitch * 0.5 * base.size().minCoeff());
    case House::Roof::gable_to_street: {  // In a frame turned by a quarter, the house lies at negative y.
      const Box<2> turned = flat(base.low[1], base.high[1], -base.high[0], -base.low[0]);
      return add_gable_roof(roof, place.at(Vec<3>::Zero(), kQuarter), turned, z, kPitch * 0.5 * base.size()[0]);
    }
  }
}

}  // namespace

void add_house(Scenery<3>& scenery, const Placement<3>& place, const House& house, Random& random) {
  const FloorPlanOptions options{.rooms = house.rooms};
  const Box<2> outer = flat(0.0, house.width, 0.0, house.depth);
  const FloorPlan plan = plan_rooms(outer.grown(-options.wall), options, random);  // The same on every storey.
  const double top = kFloor + house.storeys * kStorey;

  Blocks<3> body;
  body.fill(upright(outer, kFooting, top));
  std::vector<Box<2>> doors{entrance(plan, false, options)};
  if (house.court) doors.push_back(entrance(plan, true, options));
  if (house.annex) {
    doors.push_back(annex_door(plan, options));
    add_annex(body, house, doors.back().center()[1], options);
  }
  for (const Box<2>& door : doors) body.carve(upright(door, kFloor, kFloor + kDoorHeight));
  for (int storey = 0; storey < house.storeys; ++storey) {
    const std::span<const Box<2>> here = std::span(doors).first(storey == 0 ? doors.size() : 0);
    carve_storey(body, plan, windows(plan, here, options), kFloor + storey * kStorey);
  }
  doors.insert(doors.end(), plan.doors.begin(), plan.doors.end());
  const Stair stair = place_stair(plan, doors);
  for (int storey = 1; storey < house.storeys; ++storey) {
    const double floor = kFloor + storey * kStorey;
    body.carve(upright(stair.hole, floor - kSlab, floor));
    add_flight(scenery["stair"], place, stair, floor - kStorey);
  }
  if (house.roof == House::Roof::flat) body.fill(upright(outer, top, top + 0.5)).carve(upright(plan.inside, top, top + 0.5));
  body.append_to(scenery["house"], place);
  add_roof(scenery, place, house, top);
  if (house.court) {
    const Box<2> yard = flat(kBite, house.width - kBite, house.depth - kBite, house.depth + kCourtDepth);
    const double gate = 0.5 * house.width;
    add_yard_wall(scenery, place, yard, 2.2,
                  {flat(0.3 + kBite, house.width - 0.3 - kBite, house.depth - 1.0, house.depth + 1.0),
                   flat(gate - 1.2, gate + 1.2, house.depth + 1.0, house.depth + kCourtDepth)});
  }
}

void add_hall(Scenery<3>& scenery, const Placement<3>& place) {
  constexpr double kLength = 24.0, kDepth = 13.0, kWall = 0.4, kHeight = 5.6;
  Blocks<3> body;
  body.fill(solid(0.0, kLength, 0.0, kDepth, kFooting, kHeight + kSlab));
  body.carve(solid(kWall, kLength - kWall, kWall, kDepth - kWall, kFloor, kHeight));
  for (const double x : {3.0, 9.5}) body.carve(solid(x, x + 3.8, 0.0, kWall, kFloor, 4.2));
  body.carve(solid(6.0, 8.4, kDepth - kWall, kDepth, kFloor, 2.6));
  for (const double x : {15.5, 18.5, 21.3}) body.carve(solid(x, x + 1.6, 0.0, kWall, 1.0, 2.4));
  for (const double x : {2.0, 10.5, 13.5, 16.5, 20.0}) body.carve(solid(x, x + 1.8, kDepth - kWall, kDepth, 3.2, 4.7));
  body.fill(solid(14.8, kLength, 5.0, 5.2, kFooting, 2.9)).fill(solid(14.8, 15.0, 0.0, 5.2, kFooting, 2.9));  // The office, open above.
  body.carve(solid(14.8, 15.0, 1.8, 3.8, kFloor, 2.3));
  body.append_to(scenery["house"], place);
  add_gable_roof(scenery["roof"], place, flat(-kOverhang, kLength + kOverhang, -kOverhang, kDepth + kOverhang), kHeight + kSlab - kBite, 2.2);
  for (const double x : {5.0, 9.5, 14.0, 18.5})
    add_box(scenery["column"], place, solid(x - 0.15, x + 0.15, 7.0, 7.3, kFloor - kBite, kHeight + kBite));
}

void add_church(Scenery<3>& scenery, const Placement<3>& place) {
  constexpr double kNave = 6.0, kChancel = 30.0, kTower = 14.5, kEaves = 8.0;  // Where nave and chancel begin; heights [m].
  Blocks<3> body;
  body.fill(solid(-6.0, 6.0, kNave, kChancel, kFooting, kEaves));
  body.fill(solid(-4.0, 4.0, kChancel, kChurchLength, kFooting, 6.5));
  body.fill(solid(-3.3, 3.3, 0.0, 6.6, kFooting, kTower));
  body.carve(solid(-5.5, 5.5, 6.6, kChancel - 0.5, kFloor, kEaves - 0.5));   // Nave,
  body.carve(solid(-3.5, 3.5, kChancel, kChurchLength - 0.5, kFloor, 6.0));  // chancel,
  body.carve(solid(-2.5, 2.5, kChancel - 0.5, kChancel, kFloor, 5.0));       // the arch between them,
  body.carve(solid(-2.5, 2.5, 0.8, 5.8, kFloor, 5.0));                       // porch,
  body.carve(solid(-1.2, 1.2, 0.0, 0.8, kFloor, 3.0));                       // the door to the square,
  body.carve(solid(-1.2, 1.2, 5.8, 6.6, kFloor, 3.2));                       // the door to the nave,
  body.carve(solid(5.5, 6.0, 23.5, 25.3, kFloor, 2.5));                      // a side door,
  body.carve(solid(-2.6, 2.6, 0.7, 5.9, 10.2, 13.6));                        // belfry.
  for (const auto& [x0, x1, y0, y1] : {std::array{-3.3, -2.6, 2.4, 4.2}, {2.6, 3.3, 2.4, 4.2}, {-0.9, 0.9, 0.0, 0.7}, {-0.9, 0.9, 5.9, 6.6}})
    body.carve(solid(x0, x1, y0, y1, 10.8, 13.2));
  for (const double y : {8.6, 12.6, 16.6, 20.6, 26.6}) {
    body.carve(solid(-6.0, -5.5, y, y + 1.3, 2.4, 6.2));
    body.carve(solid(5.5, 6.0, y, y + 1.3, 2.4, 6.2));
  }
  for (const double x : {-2.3, 1.1}) body.carve(solid(x, x + 1.2, kChurchLength - 0.5, kChurchLength, 1.8, 5.0));
  body.append_to(scenery["church"], place);

  const Placement<3> lengthwise = place.at(Vec<3>::Zero(), kQuarter);  // x along the nave, the sides keep their places by symmetry.
  add_gable_roof(scenery["roof"], lengthwise, flat(kNave - 0.3, kChancel + 0.5, -6.5, 6.5), kEaves - kBite, 4.6);
  add_gable_roof(scenery["roof"], lengthwise, flat(kChancel - 0.2, kChurchLength + 0.5, -4.4, 4.4), 6.5 - kBite, 3.2);
  add_loft(scenery["roof"], {rectangle(place, flat(-3.6, 3.6, -0.3, 6.9), kTower - kBite), {place({0.0, 3.3, 20.0})}});
  for (const double y : {11.0, 15.0, 19.0, 23.0, 27.0})
    for (const double x : {-3.4, 3.4}) add_cylinder(scenery["column"], place({x, y, kFloor - kBite}), place({x, y, kEaves - 0.5 + kBite}), 0.35, 12);
  for (int row = 0; row < 8; ++row)
    for (const double x : {-2.85, 0.95})
      add_box(scenery["furniture"], place, solid(x, x + 1.9, 11.6 + 1.7 * row, 12.0 + 1.7 * row, kFloor - kBite, kFloor + 0.9));
  add_box(scenery["furniture"], place, solid(-1.2, 1.2, 33.5, 34.4, kFloor - kBite, kFloor + 1.0));  // Altar.
}

void add_yard_wall(Scenery<3>& scenery, const Placement<3>& place, const Box<2>& yard, double height, const std::vector<Box<2>>& openings) {
  constexpr double kThick = 0.3;
  Blocks<3> wall;
  wall.fill(upright(yard, kFooting, height)).carve(upright(yard.grown(-kThick), kFooting, height));
  for (const Box<2>& gap : openings) wall.carve(upright(gap, kFooting, height));
  wall.append_to(scenery["wall"], place);
}

}  // namespace vantage
