// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/floor_plan.h"

#include <algorithm>
#include <numeric>

namespace vantage {
namespace {

constexpr double kTouch = 1e-9;  // [m]
constexpr double kJamb = 0.2;    // Of wall that is left beside a door [m].

double area(const Box<2>& box) { return box.size().prod(); }

/// Cuts the largest room in two across its longer axis; false if the halves would be too narrow.
bool split_largest(std::vector<Box<2>>& rooms, const FloorPlanOptions& options, Random& random) {
  const auto room = std::max_element(rooms.begin(), rooms.end(), [](const Box<2>& a, const Box<2>& b) { return area(a) < area(b); });
  const int axis = room->size()[0] >= room->size()[1] ? 0 : 1;
  const double slack = room->size()[axis] - 2.0 * options.min_side - options.wall;
  const double share = random.uniform(0.15, 0.85);
  if (slack < 0.0) return false;
  Box<2> rest = *room;
  room->high[axis] = room->low[axis] + options.min_side + share * slack;
  rest.low[axis] = room->high[axis] + options.wall;
  rooms.push_back(rest);
  return true;
}

/// The piece of wall between two rooms, empty if there is none.
Box<2> wall_between(const Box<2>& a, const Box<2>& b, double wall) {
  for (int axis = 0; axis < 2; ++axis) {
    const Box<2>& low = a.low[axis] < b.low[axis] ? a : b;
    const Box<2>& high = a.low[axis] < b.low[axis] ? b : a;
    if (std::abs(high.low[axis] - low.high[axis] - wall) > kTouch) continue;
    Box<2> shared{a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
    shared.low[axis] = low.high[axis];
    shared.high[axis] = high.low[axis];
    if (!shared.empty()) return shared;
  }
  return {};
}

/// Opening of `width` across a piece of wall that runs along `axis`, `share` of the way along it.
Box<2> opening(Box<2> wall, int axis, double width, double share) {
  const double middle = wall.low[axis] + share * wall.size()[axis];
  wall.low[axis] = middle - 0.5 * width;
  wall.high[axis] = middle + 0.5 * width;
  return wall;
}

/// Doors in the longest pieces of wall that join rooms not joined yet; false if some room stays apart.
bool join_rooms(FloorPlan& plan, const FloorPlanOptions& options) {
  struct Wall {
    std::size_t a, b;
    Box<2> box;
    double length;
  };
  std::vector<Wall> walls;
  for (std::size_t b = 0; b < plan.rooms.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const Box<2> box = wall_between(plan.rooms[a], plan.rooms[b], options.wall);
      if (!box.empty() && box.size().maxCoeff() >= options.door + 2.0 * kJamb) walls.push_back({a, b, box, box.size().maxCoeff()});
    }
  std::stable_sort(walls.begin(), walls.end(), [](const Wall& x, const Wall& y) { return x.length > y.length; });
  std::vector<std::size_t> group(plan.rooms.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const Wall& wall : walls) {
    const std::size_t kept = group[wall.a], merged = group[wall.b];
    if (kept == merged) continue;
    std::replace(group.begin(), group.end(), merged, kept);
    plan.doors.push_back(opening(wall.box, wall.box.size()[0] > wall.box.size()[1] ? 0 : 1, options.door, 0.5));
  }
  return std::all_of(group.begin(), group.end(), [&](std::size_t g) { return g == group[0]; });
}

/// The outer wall of a room on one side; empty if that side does not stand at the outer wall.
Box<2> outer_wall(const FloorPlan& plan, const Box<2>& room, int axis, bool high, double wall) {
  Box<2> box = room;
  const double outer = high ? plan.inside.high[axis] : plan.inside.low[axis];
  if (std::abs((high ? room.high[axis] : room.low[axis]) - outer) > kTouch) return {};
  box.low[axis] = high ? outer : outer - wall;
  box.high[axis] = high ? outer + wall : outer;
  return box;
}

}  // namespace

FloorPlan plan_rooms(const Box<2>& inside, const FloorPlanOptions& options, Random& random) {
  constexpr int kTries = 8;
  for (int wanted = kTries * options.rooms;; --wanted) {  // One room, at last, needs no doors.
    FloorPlan plan{inside, {inside}, {}};
    while (static_cast<int>(plan.rooms.size()) < (wanted + kTries - 1) / kTries && split_largest(plan.rooms, options, random)) {
    }
    if (join_rooms(plan, options)) return plan;
  }
}

std::vector<Box<2>> windows(const FloorPlan& plan, std::span<const Box<2>> entrances, const FloorPlanOptions& options) {
  constexpr double kWideSide = 6.0;
  const auto beside_entrance = [&](const Box<2>& window) {
    return std::any_of(entrances.begin(), entrances.end(), [&](const Box<2>& e) { return !e.grown(2.0 * kJamb).intersection(window).empty(); });
  };
  std::vector<Box<2>> all;
  for (const Box<2>& room : plan.rooms)
    for (int axis = 0; axis < 2; ++axis)
      for (const bool high : {false, true}) {
        const Box<2> wall = outer_wall(plan, room, axis, high, options.wall);
        if (wall.empty() || wall.size()[1 - axis] < options.window + 4.0 * kJamb) continue;
        const int count = wall.size()[1 - axis] < kWideSide ? 1 : 2;
        for (int i = 0; i < count; ++i) {
          const Box<2> window = opening(wall, 1 - axis, options.window, (i + 0.5) / count);
          if (!beside_entrance(window)) all.push_back(window);
        }
      }
  return all;
}

Box<2> entrance(const FloorPlan& plan, bool back, const FloorPlanOptions& options) {
  Box<2> widest;
  for (const Box<2>& room : plan.rooms) {
    const Box<2> wall = outer_wall(plan, room, 1, back, options.wall);
    if (!wall.empty() && (widest.empty() || wall.size()[0] > widest.size()[0])) widest = wall;
  }
  return opening(widest, 0, options.door, 0.5);
}

}  // namespace vantage
