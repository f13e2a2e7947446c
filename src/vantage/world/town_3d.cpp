// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "vantage/world/buildings_3d.h"
#include "vantage/world/generators.h"
#include "vantage/world/outdoors_3d.h"
#include "vantage/world/shapes_3d.h"

namespace vantage {
namespace {

constexpr double kPavement = 1.6;  // Width beside a street [m].

struct Street {
  Vec<2> from, to;  ///< Middle of the carriageway [m].
  double width;     ///< Of the carriageway [m].

  [[nodiscard]] double length() const { return (to - from).norm(); }
  [[nodiscard]] Vec<2> at(double along, double left) const {
    const Vec<2> d = (to - from) / length();
    return from + along * d + left * Vec<2>(-d[1], d[0]);
  }
  /// Frame of one side: x along the street, y away from its middle. It begins `along` the street on the left side; the right side's x runs back.
  [[nodiscard]] Placement<3> side(bool left, double along) const {
    const Vec<2> p = at(along, 0.0), d = (left ? 1.0 : -1.0) * (to - from) / length();
    return {Vec<3>(p[0], p[1], 0.0), d[0], d[1]};
  }
};

/// A stretch of one side of a street, with houses on lots of equal width.
struct Row {
  const Street& street;
  bool left;
  double from, to;  ///< Along the street [m].
  int lots;         ///< 0: only the pavement.

  [[nodiscard]] double length() const { return to - from; }
  [[nodiscard]] Placement<3> frame() const { return street.side(left, left ? from : to); }
};

/// What stands on a lot: a house of its own size, roof and rooms.
House draw_house(double lot, Random& random) {
  House house;
  house.width = std::clamp(random.uniform(0.58, 0.82) * lot, 8.0, 13.0);
  house.depth = random.uniform(7.6, 10.4);
  house.storeys = random.uniform() < 0.5 ? 2 : 1;
  house.rooms = 2 + static_cast<int>(random.below(3));
  constexpr std::array kRoofs{House::Roof::gable, House::Roof::gable, House::Roof::gable_to_street, House::Roof::hip, House::Roof::flat};
  house.roof = kRoofs[random.below(kRoofs.size())];
  house.annex = lot - house.width > kAnnexWidth + 1.6 && random.uniform() < 0.7;
  house.court = random.uniform() < 0.35;
  return house;
}

/// Low wall along the street with a gap before the door side.
void add_front_wall(Scenery<3>& scenery, const Placement<3>& place, double width, double gap) {
  Mesh<3>& wall = scenery["wall"];
  add_box(wall, place, {Vec<3>(0.0, 0.0, -0.3), Vec<3>(gap, 0.3, 0.9)});
  add_box(wall, place, {Vec<3>(gap + 3.0, 0.0, -0.3), Vec<3>(width, 0.3, 0.9)});
}

void add_row(Scenery<3>& scenery, const Row& row, Random& random) {
  const Placement<3> frame = row.frame();
  const double kerb = 0.5 * row.street.width, lot = row.length() / std::max(row.lots, 1);
  add_box(scenery["kerb"], frame, {Vec<3>(0.0, kerb, -0.3), Vec<3>(row.length(), kerb + kPavement, 0.12)});
  for (int i = 0; i < row.lots; ++i) {
    const House house = draw_house(lot, random);
    const double garden = random.uniform(0.6, 3.6), front = kerb + kPavement + garden;
    const double wide = house.width + (house.annex ? kAnnexWidth : 0.0), x = i * lot + random.uniform(0.2, 0.8) * (lot - wide);
    add_house(scenery, frame.at({x, front, 0.0}), house, random);
    if (garden > 2.2)
      add_front_wall(scenery, frame.at({i * lot + 0.6, kerb + kPavement + 0.1, 0.0}), lot - 1.2, x - i * lot + random.uniform(1.0, 4.0));
    if (!house.court && random.uniform() < 0.7) {
      const Vec<3> tree = frame({x + random.uniform(0.0, house.width), front + house.depth + 3.2, 0.0});
      add_tree(scenery, tree.head<2>(), random.uniform(5.0, 8.0), random);
    }
    if (random.uniform() < 0.45) add_car(scenery, frame.at({i * lot + random.uniform(4.0, lot - 4.0), kerb - 1.2, 0.0}), random);
  }
}

/// Poles beside the right side of a street, `every` so many metres.
void add_poles(std::vector<Vec<2>>& feet, const Street& along, double from, double to, double every) {
  for (double t = from; t <= to; t += every) feet.push_back(along.at(t, -0.5 * along.width - 0.45));
}

/// The church with its yard on the east of the square, and what stands on the square.
void add_square(Scenery<3>& scenery, Random& random) {
  const Placement<3> church = Placement<3>{Vec<3>(123.5, 88.5, 0.0)}.at(Vec<3>::Zero(), -0.5 * kPi);  // Its front looks west.
  add_church(scenery, church);
  const Box<2> yard{Vec<2>(-11.5, 3.0), Vec<2>(11.5, kChurchLength + 3.5)};  // In the church's frame, open towards the square.
  add_yard_wall(scenery, church, yard, 1.3, {{Vec<2>(-11.0, 2.0), Vec<2>(11.0, 6.0)}, {Vec<2>(-1.5, 38.0), Vec<2>(1.5, 42.0)}});
  for (double y = 9.5; y < kChurchLength; y += 8.5)
    for (const double x : {-9.0, 9.0}) {
      const Vec<3> foot = church({x, y + random.uniform(-1.0, 1.0), 0.0});
      add_tree(scenery, foot.head<2>(), random.uniform(5.0, 7.0), random);
    }
  add_fountain(scenery, {109.0, 89.0});
  for (const double turn : {0.25, 0.75, 1.25, 1.75}) {
    const auto [s, c] = sin_cos(turn * kPi);
    add_bench(scenery, Placement<3>{Vec<3>(109.0 + 5.0 * c, 89.0 + 5.0 * s, 0.0)}.at(Vec<3>::Zero(), (turn + 0.5) * kPi));
  }
  for (const double y : {80.0, 86.0, 92.0, 98.0}) add_tree(scenery, {98.5, y}, random.uniform(5.5, 7.0), random);
  for (const double x : {103.0, 106.0, 114.5}) add_car(scenery, Placement<3>{Vec<3>(x, 101.0, 0.0)}.at(Vec<3>::Zero(), 0.5 * kPi), random);
}

/// The hall with its lorry in a walled yard.
void add_yard(Scenery<3>& scenery, const Street& lane, Random& random) {
  const Placement<3> place = lane.side(true, 14.0).at({0.0, 15.0, 0.0});
  add_hall(scenery, place);
  const Box<2> yard{Vec<2>(-4.0, -10.5), Vec<2>(28.0, 16.5)};
  add_yard_wall(scenery, place, yard, 2.4, {{Vec<2>(8.0, -11.0), Vec<2>(13.0, -9.0)}, {Vec<2>(27.0, 14.0), Vec<2>(29.0, 16.0)}});
  add_lorry(scenery, place.at({20.0, -4.0, 0.0}, 0.1));
  add_car(scenery, place.at({2.0, -5.5, 0.0}, 1.4), random);
}

}  // namespace

Scene<3> make_town(std::uint64_t seed) {
  const SceneSetting<3> setting{.name = "town",
                                .domain = {Vec<3>(0.0, 0.0, -0.5), Vec<3>(200.0, 150.0, 22.0)},
                                .start = Vec<3>(103.0, 83.0, 2.0),
                                .voxel = 0.5,
                                .eta = 0.1,
                                .range = 80.0,
                                .clearance = 0.5};
  const Vec<2> cross(92.0, 70.0);
  const Street west{Vec<2>(-6.0, 62.0), cross, 7.0}, east{cross, Vec<2>(206.0, 64.0), 7.0};
  const Street north{cross, Vec<2>(86.0, 156.0), 6.5}, south{cross, Vec<2>(100.0, -6.0), 6.5};
  const Street back_lane{Vec<2>(89.0, 113.0), Vec<2>(206.0, 108.0), 5.5}, yard_lane{Vec<2>(-6.0, 104.0), Vec<2>(89.4, 109.0), 5.5};
  const std::vector<Row> rows{{west, true, 8.0, 88.0, 5},
                              {west, false, 8.0, 86.0, 5},
                              {east, true, 72.0, 106.0, 2},
                              {east, false, 14.0, 106.0, 5},
                              {back_lane, true, 10.0, 108.0, 5},
                              {back_lane, false, 76.0, 108.0, 2},
                              {yard_lane, true, 50.0, 84.0, 2},
                              {south, true, 34.0, 68.0, 2},
                              // Pavements alone: along the square, and out of town.
                              {east, true, 5.0, 70.0, 0},
                              {back_lane, false, 5.0, 74.0, 0},
                              {north, false, 6.0, 38.0, 0},
                              {north, true, 6.0, 34.0, 0},
                              {north, true, 44.0, 77.0, 0},
                              {north, false, 48.0, 77.0, 0},
                              {south, true, 6.0, 32.0, 0},
                              {south, false, 6.0, 68.0, 0}};

  Scenery<3> scenery;
  add_ground(scenery["ground"], {Vec<2>(-20.0, -20.0), Vec<2>(220.0, 170.0)}, 0.0, 10.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Random random(seed, i + 1);  // A row stays as it is when another one changes.
    add_row(scenery, rows[i], random);
  }
  Random random(seed);
  add_square(scenery, random);
  add_yard(scenery, yard_lane, random);
  std::vector<Vec<2>> feet;
  add_poles(feet, west, 8.0, 84.0, 25.0);
  add_poles(feet, east, 12.0, 109.0, 24.0);
  add_power_line(scenery, feet);
  feet.clear();
  add_poles(feet, back_lane, 8.0, 108.0, 25.0);
  add_power_line(scenery, feet);
  add_grove(scenery, {Vec<2>(8.0, 4.0), Vec<2>(84.0, 36.0)}, 45, random);
  add_grove(scenery, {Vec<2>(4.0, 140.0), Vec<2>(80.0, 148.0)}, 14, random);
  add_grove(scenery, {Vec<2>(6.0, 88.0), Vec<2>(80.0, 98.0)}, 12, random);
  add_grove(scenery, {Vec<2>(96.0, 138.0), Vec<2>(196.0, 148.0)}, 20, random);
  add_grove(scenery, {Vec<2>(128.0, 3.0), Vec<2>(197.0, 40.0)}, 40, random);
  return scenery.scene(setting);
}

}  // namespace vantage
