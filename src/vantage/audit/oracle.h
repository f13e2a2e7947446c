// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/audit/sight_table.h"

namespace vantage {

/// Scans needed until `share` of the reference set is covered; nullopt: never. `coverage[k]` is the share after k + 1 scans.
[[nodiscard]] std::optional<std::int64_t> scans_to(std::span<const double> coverage, double share);

/// How the greedy choice is made.
struct GreedyOptions {
  bool from_seen = false;  ///< Only places that earlier scans have seen may be chosen: an explorer's situation, but with a map.
  bool walls = false;      ///< `goal` of the walls must be seen too; what exceeds the goal, of volume or walls, is worth nothing.
  double goal = 0.99;      ///< [1]
  bool lazy = true;        ///< Re-evaluate only the top of the heap: gains can only fall. Same answer as evaluating all.
};

/// Scans in the order an oracle takes them.
struct OracleRun {
  std::vector<std::size_t> places;  ///< Candidates of the table, the start first.
  std::vector<double> coverage;     ///< Share of the targets seen after each [1].
  std::vector<double> walls;        ///< Share of the walls seen after each [1]; empty if the table has none.

  [[nodiscard]] std::optional<std::int64_t> scans_to(double share) const { return vantage::scans_to(coverage, share); }
  /// Until the share of the targets and that of the walls, if there are any, are reached.
  [[nodiscard]] std::optional<std::int64_t> scans_to_both(double share) const;
};

/// Greedy set cover: always the place that sees most of what is left, the smaller index at a tie, until nothing can be gained. With `walls` what
/// counts is the sum of the two shares, each cut at the goal (Wolsey 1982), and the run ends where both are reached.
template <int Dim>
[[nodiscard]] OracleRun greedy_oracle(const SightTable<Dim>& table, const GreedyOptions& options = {});

}  // namespace vantage
