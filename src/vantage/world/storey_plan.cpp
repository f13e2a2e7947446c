// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/storey_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/world/floor_plan.h"

namespace vantage {
namespace {

constexpr double kTouch = 1e-9;                    // [m]
constexpr double kJamb = 0.2;                      // Of wall that is left beside a door [m].
constexpr double kThinnest = 5.0;                  // Block of rooms [m].
constexpr double kNarrowest = 1.9, kWidest = 2.7;  // Corridors [m].

/// What corridors leave: a part of the storey, and the sides on which a corridor runs beyond the wall.
struct Block {
  Box<2> box;
  std::array<std::array<bool, 2>, 2> corridor{};  ///< By axis, then low and high.
};

double area(const Block& block) { return block.box.size().prod(); }
bool touches_corridor(const Block& block, int axis) {
  return block.corridor[static_cast<std::size_t>(axis)][0] || block.corridor[static_cast<std::size_t>(axis)][1];
}

class Planner {
 public:
  Planner(const StoreyOptions& options, Random& random, StoreyPlan& plan) : options_(options), random_(random), plan_(plan) {}

  /// Corridors through the block and its parts until these are small; the parts.
  void divide(const Block& block) {
    const Vec<2> size = block.box.size();
    const int longer = size[0] >= size[1] ? 0 : 1;
    if (size[1 - longer] <= options_.block && size[longer] <= 1.5 * options_.block) return blocks_.push_back(block);
    const bool first = plan_.corridors.empty();
    for (const int axis : {first ? longer : 1 - longer, first ? 1 - longer : longer})
      if ((first || touches_corridor(block, axis)) && size[1 - axis] >= 2.0 * (kThinnest + options_.wall) + kWidest) return cut(block, axis);
    blocks_.push_back(block);
  }

  void add_rooms() {
    double left = 0.0;
    for (const Block& block : blocks_) left += area(block);
    for (const Block& block : blocks_) {
      const double share = (options_.rooms - static_cast<double>(plan_.rooms.size())) * area(block) / left;
      add_block(block, std::max(1, static_cast<int>(std::ceil(1.15 * share))));
      left -= area(block);
    }
  }

 private:
  /// A corridor along `axis`, and on.
  void cut(const Block& block, int axis) {
    const auto a = static_cast<std::size_t>(axis);
    const int across = 1 - axis;
    const double width = random_.uniform(kNarrowest, kWidest), least = kThinnest + options_.wall;
    const double slack = block.box.size()[across] - 2.0 * least - width;
    Box<2> corridor = block.box;
    corridor.low[across] += least + random_.uniform(0.25, 0.75) * slack;
    corridor.high[across] = corridor.low[across] + width;
    Block low = block, high = block;
    low.box.high[across] = corridor.low[across] - options_.wall;
    high.box.low[across] = corridor.high[across] + options_.wall;
    low.corridor[1 - a][1] = high.corridor[1 - a][0] = true;
    for (const bool end : {false, true})
      if (block.corridor[a][end ? 1 : 0]) join(corridor, axis, end);
    plan_.corridors.push_back(corridor);
    divide(low);
    divide(high);
  }

  /// The corridor's end on to the one that it meets: open, or by a door.
  void join(Box<2>& corridor, int axis, bool high) {
    Box<2> gap = corridor;
    (high ? gap.low : gap.high)[axis] = high ? corridor.high[axis] : corridor.low[axis];
    (high ? gap.high : gap.low)[axis] += high ? options_.wall : -options_.wall;
    if (random_.uniform() < 0.3)
      plan_.doors.push_back(door_in(gap, 1 - axis, 0.5));
    else
      corridor.extend(gap);
  }

  /// Opening in a piece of wall that runs along `axis`, `share` of the way from jamb to jamb.
  [[nodiscard]] Box<2> door_in(Box<2> wall, int axis, double share) const {
    wall.low[axis] += kJamb + share * (wall.size()[axis] - options_.door - 2.0 * kJamb);
    wall.high[axis] = wall.low[axis] + options_.door;
    return wall;
  }

  /// Rooms in a block, half of those beside a corridor with a door to it.
  void add_block(const Block& block, int rooms) {
    const FloorPlan part =
        plan_rooms(block.box, {.rooms = rooms, .wall = options_.wall, .door = options_.door, .min_side = options_.min_side}, random_);
    plan_.rooms.insert(plan_.rooms.end(), part.rooms.begin(), part.rooms.end());
    plan_.doors.insert(plan_.doors.end(), part.doors.begin(), part.doors.end());
    std::vector<Box<2>> exits;
    for (const Box<2>& room : part.rooms)
      for (int side = 0; side < 4; ++side)
        if (const Box<2> wall = wall_to_corridor(block, room, side / 2, side % 2 != 0); !wall.empty())
          exits.push_back(door_in(wall, 1 - side / 2, random_.uniform()));
    const std::size_t always = exits.empty() ? 0 : random_.below(exits.size());
    for (std::size_t i = 0; i < exits.size(); ++i)
      if (i == always || random_.uniform() < 0.5) plan_.doors.push_back(exits[i]);
  }

  /// The wall between a room and the corridor on one side of its block; empty if there is none.
  [[nodiscard]] Box<2> wall_to_corridor(const Block& block, const Box<2>& room, int axis, bool high) const {
    const double end = high ? block.box.high[axis] : block.box.low[axis];
    if (!block.corridor[static_cast<std::size_t>(axis)][high ? 1 : 0] || std::abs((high ? room.high : room.low)[axis] - end) > kTouch) return {};
    Box<2> wall = room;
    wall.low[axis] = high ? end : end - options_.wall;
    wall.high[axis] = high ? end + options_.wall : end;
    return wall;
  }

  const StoreyOptions& options_;
  Random& random_;
  StoreyPlan& plan_;
  std::vector<Block> blocks_;
};

}  // namespace

StoreyPlan plan_storey(const Box<2>& inside, const StoreyOptions& options, Random& random) {
  StoreyPlan plan{inside, {}, {}, {}};
  Planner planner(options, random, plan);
  planner.divide({inside});
  planner.add_rooms();
  require(static_cast<int>(plan.rooms.size()) >= options.rooms,
          fmt::format("a storey of {:.1f} x {:.1f} m has no place for {} rooms", inside.size()[0], inside.size()[1], options.rooms), "floor");
  return plan;
}

}  // namespace vantage
