// SPDX-License-Identifier: Apache-2.0
// The fewest scans beside the optimum by trying all choices.
#include "vantage/audit/fewest_scans.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>

#include "vantage/base/random.h"

namespace vantage {
namespace {

void set(std::vector<std::uint64_t>& row, std::size_t column) { row[column / 64] |= std::uint64_t{1} << (column % 64); }

/// Random rows; every place sees itself. The last `hidden` targets are seen from nowhere.
SightTable<2> random_table(std::uint64_t seed, std::size_t targets, std::size_t candidates, std::size_t hidden) {
  Random random(seed);
  SightTable<2> table;
  table.targets = targets;
  for (std::size_t c = 0; c < candidates; ++c) {
    std::vector<std::uint64_t> row((targets + candidates + 63) / 64);
    const double own = random.uniform(0.05, 0.5);
    for (std::size_t t = 0; t < targets - hidden; ++t)
      if (random.uniform() < own || t % candidates == c) set(row, t);
    set(row, targets + c);
    table.candidates.push_back(Vec<2>::Zero());
    table.rows.push_back(row);
  }
  return table;
}

double share_seen(const SightTable<2>& table, const std::vector<std::size_t>& places) {
  std::size_t seen = 0;
  for (std::size_t t = 0; t < table.targets; ++t)
    seen += std::any_of(places.begin(), places.end(), [&](std::size_t c) { return table.sees(c, t); }) ? 1 : 0;
  return static_cast<double>(seen) / static_cast<double>(table.targets);
}

std::int64_t optimum(const SightTable<2>& table, double share) {
  std::int64_t least = static_cast<std::int64_t>(table.candidates.size()) + 1;
  for (std::uint32_t bits = 1; bits < 1U << table.candidates.size(); bits += 2) {  // The start is always among them.
    std::vector<std::size_t> places;
    for (std::size_t c = 0; c < table.candidates.size(); ++c)
      if (bits >> c & 1U) places.push_back(c);
    if (std::popcount(bits) < least && share_seen(table, places) >= share) least = std::popcount(bits);
  }
  return least;
}

RC_GTEST_PROP(FewestScans, AreTheOptimumOfSmallTables, (std::uint64_t seed)) {
  const SightTable<2> table = random_table(seed, 20 + seed % 100, 2 + seed % 9, seed % 3);
  const OracleRun greedy = greedy_oracle(table);
  for (const double share : {0.8, 0.9, 0.99}) {
    const auto fewest = fewest_scans(table, greedy, share, 100'000'000);
    RC_ASSERT(fewest.has_value() == greedy.scans_to(share).has_value());
    if (!fewest) continue;
    RC_ASSERT(fewest->proven());
    RC_ASSERT(fewest->at_least == optimum(table, share));
    RC_ASSERT(fewest->places.front() == 0U);
    RC_ASSERT(share_seen(table, fewest->places) >= share);
    RC_ASSERT(fewest->relaxation <= static_cast<double>(fewest->at_least) + 1e-6);
    const auto hasty = fewest_scans(table, greedy, share, 0);
    RC_ASSERT(hasty->at_least <= fewest->at_least);
    RC_ASSERT(static_cast<std::int64_t>(hasty->places.size()) <= *greedy.scans_to(share));
    RC_ASSERT(share_seen(table, hasty->places) >= share);
  }
}

TEST(FewestScans, GreedyMayTakeOneMore) {
  // Two halves see all; the greedy one begins with the larger middle.
  SightTable<2> table;
  table.targets = 100;
  const auto add = [&](std::size_t first, std::size_t last) {
    std::vector<std::uint64_t> row(2);
    for (std::size_t t = first; t < last; ++t) set(row, t);
    set(row, table.targets + table.candidates.size());
    table.candidates.push_back(Vec<2>::Zero());
    table.rows.push_back(row);
  };
  add(0, 2);
  add(2, 51);
  add(51, 100);
  add(20, 80);
  const OracleRun greedy = greedy_oracle(table);
  ASSERT_EQ(greedy.scans_to(0.99), 4);
  const auto fewest = fewest_scans(table, greedy, 0.99, 1'000'000);
  ASSERT_TRUE(fewest);
  EXPECT_EQ(fewest->at_least, 3);
  EXPECT_EQ(fewest->places, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(FewestScans, TheStartAloneMayDo) {
  SightTable<2> table;
  table.targets = 3;
  table.candidates.assign(2, Vec<2>::Zero());
  table.rows.assign(2, {7});
  const auto fewest = fewest_scans(table, greedy_oracle(table), 0.99, 1000);
  ASSERT_TRUE(fewest);
  EXPECT_EQ(fewest->at_least, 1);
  EXPECT_TRUE(fewest->proven());
}

}  // namespace
}  // namespace vantage
