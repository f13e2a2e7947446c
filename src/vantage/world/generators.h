// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "vantage/world/scene.h"

namespace vantage {

// The built-in scenes; scene.cpp lists them with their parameters and checks these. Equal arguments, equal bytes.

[[nodiscard]] Scene<2> make_planar(int blobs, std::uint64_t seed);  ///< Fig. 2.
[[nodiscard]] Scene<2> make_discs(int discs, std::uint64_t seed);
[[nodiscard]] Scene<3> make_pipes(int cylinders, bool symmetric, std::uint64_t seed);  ///< Figs. 3, 4.
[[nodiscard]] Scene<3> make_town(std::uint64_t seed);
[[nodiscard]] Scene<3> make_patio(std::uint64_t seed);                              ///< Figs. 5, 6.
[[nodiscard]] Scene<3> make_church(std::uint64_t seed);                             ///< Fig. 7.
[[nodiscard]] Scene<3> make_wires(int posts, double diameter, std::uint64_t seed);  ///< Diameter of the thinnest wires [m].
[[nodiscard]] Scene<3> make_floor(int rooms, std::uint64_t seed);
[[nodiscard]] Scene<3> make_galleries(int columns, int rows, std::uint64_t seed);  ///< Of pillars.
[[nodiscard]] Scene<3> make_forest(int trees, std::uint64_t seed);
[[nodiscard]] Scene<2> make_blocks(int columns, int rows, std::uint64_t seed);
[[nodiscard]] Scene<2> make_office(std::uint64_t seed);
[[nodiscard]] Scene<2> make_town2d(int houses, std::uint64_t seed);

}  // namespace vantage
