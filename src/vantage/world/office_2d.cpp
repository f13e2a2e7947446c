// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/random.h"
#include "vantage/world/blocks.h"
#include "vantage/world/generators.h"
#include "vantage/world/scenery.h"

namespace vantage {
namespace {

constexpr double kWall = 0.3, kDoor = 1.2;  // [m]

Box<2> rectangle(double x0, double x1, double y0, double y1) { return {Vec<2>(x0, y0), Vec<2>(x1, y1)}; }

/// A row of rooms between two walls, with doors into the corridor below or above it.
struct Band {
  double from, to, low, high;
  bool door_below, door_above;
};

/// Opening at `x` in the wall below or above the band.
Box<2> door_at(const Band& band, double x, bool above) {
  const double y = above ? band.high : band.low - kWall;
  return rectangle(x - 0.5 * kDoor, x + 0.5 * kDoor, y, y + kWall);
}

void carve_band(Blocks<2>& office, const Band& band, Random& random) {
  constexpr double kNarrow = 3.4, kWide = 6.8;
  for (double x = band.from; x < band.to;) {
    double end = x + random.uniform(kNarrow, kWide);
    if (band.to - end < kNarrow + kWall) end = band.to;
    office.carve(rectangle(x, end, band.low, band.high));
    const double door = random.uniform(x + 0.8, end - 0.8);
    const bool both = band.door_below && band.door_above, above = both ? random.uniform() < 0.5 : band.door_above;
    office.carve(door_at(band, door, above));
    if (both && random.uniform() < 0.3) office.carve(door_at(band, door, !above));
    const double desk = 0.5 * (x + end), y = band.low + random.uniform(0.35, 0.65) * (band.high - band.low);
    if (random.uniform() < 0.6) office.fill(rectangle(desk - 0.7, desk + 0.7, y - 0.4, y + 0.4));
    if (end < band.to && random.uniform() < 0.2) {  // A door to the next room.
      const double side = band.low + random.uniform(0.2, 0.8) * (band.high - band.low);
      office.carve(rectangle(end, end + kWall, side - 0.5 * kDoor, side + 0.5 * kDoor));
    }
    x = end + kWall;
  }
}

}  // namespace

Scene<2> make_office(std::uint64_t seed) {
  constexpr double kLength = 40.0, kDepth = 30.0, kCorridor = 2.2;
  const SceneSetting<2> setting{.name = "office",
                                .domain = {Vec<2>::Zero(), Vec<2>(kLength, kDepth)},
                                .start = Vec<2>(3.0, 9.9),
                                .voxel = 0.25,
                                .eta = 0.05,
                                .range = 50.0,
                                .clearance = 0.35};
  Random random(seed);
  const double low = 8.8, high = 18.8, right = kLength - kWall;                            // The two long corridors begin here;
  const double cross_1 = random.uniform(9.0, 12.0), cross_2 = random.uniform(26.0, 29.0);  // the two that join them, here.
  Blocks<2> office;
  office.fill(setting.domain.grown(0.5));  // Outer walls reach out of the domain: nothing outside is to be explored.
  for (const double y : {low, high}) office.carve(rectangle(kWall, right, y, y + kCorridor));
  for (const double x : {cross_1, cross_2}) office.carve(rectangle(x, x + kCorridor, low, high));
  const double top = low + kCorridor + kWall, bottom = high - kWall;
  for (const Band& band :
       {Band{kWall, right, kWall, low - kWall, false, true}, Band{kWall, cross_1 - kWall, top, bottom, true, true},
        Band{cross_1 + kCorridor + kWall, cross_2 - kWall, top, bottom, true, true},
        Band{cross_2 + kCorridor + kWall, right, top, bottom, true, true}, Band{kWall, right, high + kCorridor + kWall, kDepth - kWall, true, false}})
    carve_band(office, band, random);
  Scenery<2> scenery;
  office.append_to(scenery["wall"]);
  return scenery.scene(setting);
}

}  // namespace vantage
