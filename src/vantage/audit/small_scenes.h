// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "vantage/world/scene.h"

namespace vantage {

/// Kinds of small scenes, each with an unlimited number of layouts, in the plane and in space by one code.
enum class SmallKind {
  box,        ///< Closed and empty.
  field,      ///< Nothing at all, or a slab far from the start.
  pillar,     ///< One solid in the open or in a closed room.
  clutter,    ///< Solids of all sizes, some across each other.
  doors,      ///< Two rooms and a door of 1 to 5 cells.
  rooms,      ///< A building divided again and again, doors of 1 to 5 cells.
  maze,       ///< All passages wide enough to walk.
  corridors,  ///< A maze whose passages have room for one row of vantage points.
  voids,      ///< Rooms some of which no door leads to.
  shut,       ///< Start in a closed room of a building.
  symmetric,  ///< Equal to itself mirrored along every axis, start in the middle.
};

/// Their names, in their order.
[[nodiscard]] std::span<const std::string_view> small_kinds();

/// A scene of 40 x 40 or 20 x 20 x 20 cells of 0.5 m. Equal arguments, equal bytes.
template <int Dim>
[[nodiscard]] Scene<Dim> make_small_scene(SmallKind kind, std::uint64_t seed);

}  // namespace vantage
