// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vantage/audit/walls.h"

namespace vantage {

struct OracleOptions {
  std::int64_t targets = 20000;    ///< Nodes of the reference set that are looked at; fewer if it is smaller.
  std::int64_t candidates = 1000;  ///< Reachable nodes a scan may be taken from; some are added where they see too little.
  std::int64_t seed = 1;           ///< Of the choice of both.
};

void describe(OracleOptions& options, const OptionVisitor& visit);

/// What could be seen from where: true lines of sight from each candidate place to each target, a bit each. Candidate 0 is the start.
template <int Dim>
  requires SpatialDim<Dim>
struct SightTable {
  std::vector<Vec<Dim>> candidates;
  std::size_t targets = 0;                            ///< Columns 0 .. targets - 1 are reference nodes, then one per candidate.
  std::vector<std::vector<std::uint64_t>> rows;       ///< Per candidate, 64 columns a word.
  std::vector<Vec<Dim>> places;                       ///< Of the targets.
  std::size_t walls = 0;                              ///< Places on the true surface; 0: not asked for.
  std::vector<std::vector<std::uint64_t>> wall_rows;  ///< Per candidate, a bit a place of the walls.

  [[nodiscard]] bool sees(std::size_t candidate, std::size_t column) const { return (rows[candidate][column / 64] >> (column % 64) & 1U) != 0; }
  [[nodiscard]] bool sees_place(std::size_t candidate, std::size_t other) const { return sees(candidate, targets + other); }
  [[nodiscard]] bool sees_wall(std::size_t candidate, std::size_t place) const {
    return (wall_rows[candidate][place / 64] >> (place % 64) & 1U) != 0;
  }
};

/// What a table is made from; all outlive the call.
template <int Dim>
struct SightInput {
  const Reference<Dim>& reference;
  const RayCaster<Dim>& truth;
  const Walls<Dim>* walls = nullptr;
};

/// Targets and candidates are drawn one from each of equally long stretches of the lattice. Until every target and wall is in view of some candidate
/// besides the start, places that see the rest are added, at most as many again. Cost: one ray a pair. Same bits for any number of threads.
template <int Dim>
[[nodiscard]] SightTable<Dim> make_sight_table(const SightInput<Dim>& input, const Vec<Dim>& start, const OracleOptions& options = {});

/// The table for another start, at the cost of one candidate: same bits as made anew.
template <int Dim>
void move_start(SightTable<Dim>& table, const SightInput<Dim>& input, const Vec<Dim>& start);

}  // namespace vantage
