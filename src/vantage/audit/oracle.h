// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/audit/reference.h"

namespace vantage {

/// Scans needed until `share` of the reference set is covered; nullopt: never. `coverage[k]` is the share after k + 1 scans.
[[nodiscard]] std::optional<std::int64_t> scans_to(std::span<const double> coverage, double share);

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
  std::size_t targets = 0;                       ///< Columns 0 .. targets - 1 are reference nodes, then one per candidate.
  std::vector<std::vector<std::uint64_t>> rows;  ///< Per candidate, 64 columns a word.

  [[nodiscard]] bool sees(std::size_t candidate, std::size_t column) const { return (rows[candidate][column / 64] >> (column % 64) & 1U) != 0; }
  [[nodiscard]] bool sees_place(std::size_t candidate, std::size_t other) const { return sees(candidate, targets + other); }
};

/// Targets and candidates are drawn one from each of equally long stretches of the lattice. Until every target is in view of some candidate, places
/// that see the rest are added, at most as many again. Cost: one ray a pair. Same bits for any number of threads.
template <int Dim>
[[nodiscard]] SightTable<Dim> make_sight_table(const Reference<Dim>& reference, const RayCaster<Dim>& truth, const Vec<Dim>& start,
                                               const OracleOptions& options = {});

/// How the greedy choice is made.
struct GreedyOptions {
  bool from_seen = false;  ///< Only places that earlier scans have seen may be chosen: an explorer's situation, but with a map.
  bool lazy = true;        ///< Re-evaluate only the top of the heap: gains can only fall. Same answer as evaluating all.
};

/// Scans in the order an oracle takes them.
struct OracleRun {
  std::vector<std::size_t> places;  ///< Candidates of the table, the start first.
  std::vector<double> coverage;     ///< Share of the targets seen after each [1].
  [[nodiscard]] std::optional<std::int64_t> scans_to(double share) const { return vantage::scans_to(coverage, share); }
};

/// Greedy set cover: always the place that sees most of what is left, the smaller index at a tie, until nothing can be gained.
template <int Dim>
[[nodiscard]] OracleRun greedy_oracle(const SightTable<Dim>& table, const GreedyOptions& options = {});

}  // namespace vantage
