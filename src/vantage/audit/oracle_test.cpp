// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>

#include "vantage/audit/test_scenes.h"
#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/base/random.h"

namespace vantage {
namespace {

using namespace test;

template <class Dimension>
class OracleOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(OracleOf, Dimensions);

template <int Dim>
struct World {
  explicit World(const Mesh<Dim>& mesh, double range = 80.0) : truth(mesh) {
    ReferenceOptions options;
    options.voxel = 0.5;
    options.clearance = 0.6;
    options.range = range;
    options.rays = 200;
    reference = make_reference(truth, cube<Dim>(0.0, 8.0), start, options);
  }
  SightTable<Dim> table(std::int64_t targets, std::int64_t candidates, std::int64_t seed = 1) const {
    OracleOptions options;
    options.targets = targets;
    options.candidates = candidates;
    options.seed = seed;
    return make_sight_table<Dim>({reference, truth}, start, options);
  }

  Vec<Dim> start = place<Dim>(3.5, 3.0);
  RayCaster<Dim> truth;
  Reference<Dim> reference;
};

void set(std::vector<std::uint64_t>& row, std::size_t column) { row[column / 64] |= std::uint64_t{1} << (column % 64); }

/// Random rows; every place sees itself.
SightTable<2> random_table(Random& random, std::size_t targets, std::size_t candidates, double density) {
  SightTable<2> table;
  table.targets = targets;
  for (std::size_t c = 0; c < candidates; ++c) {
    std::vector<std::uint64_t> row((targets + candidates + 63) / 64);
    const double own = density * random.uniform();
    for (std::size_t k = 0; k < targets + candidates; ++k)
      if (random.uniform() < own) set(row, k);
    set(row, targets + c);
    table.candidates.push_back(Vec<2>::Zero());
    table.rows.push_back(row);
  }
  return table;
}

/// Greedy by the book: sets, no words, no heap.
OracleRun plain_greedy(const SightTable<2>& table, bool from_seen) {
  OracleRun run;
  std::vector<bool> covered(table.targets), known(table.candidates.size());
  const auto gain = [&](std::size_t c) {
    std::size_t n = 0;
    for (std::size_t t = 0; t < table.targets; ++t) n += !covered[t] && table.sees(c, t) ? 1 : 0;
    return n;
  };
  for (std::size_t next = 0; next < table.candidates.size();) {
    for (std::size_t t = 0; t < table.targets; ++t) covered[t] = covered[t] || table.sees(next, t);
    for (std::size_t c = 0; c < known.size(); ++c) known[c] = known[c] || table.sees_place(next, c);
    run.places.push_back(next);
    run.coverage.push_back(static_cast<double>(std::count(covered.begin(), covered.end(), true)) / static_cast<double>(table.targets));
    next = known.size();
    for (std::size_t c = 0; c < known.size(); ++c)
      if ((!from_seen || known[c]) && gain(c) > (next < known.size() ? gain(next) : 0)) next = c;
  }
  return run;
}

TEST(Greedy, LazyEqualsEvaluatingAllEqualsTheBook) {
  Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const SightTable<2> table = random_table(random, 1 + random.below(200), 1 + random.below(40), trial % 2 == 0 ? 0.2 : 0.05);
    for (const bool from_seen : {false, true}) {
      const OracleRun book = plain_greedy(table, from_seen);
      for (const bool lazy : {false, true}) {
        const OracleRun run = greedy_oracle(table, {.from_seen = from_seen, .lazy = lazy});
        EXPECT_EQ(run.places, book.places) << trial;
        EXPECT_EQ(run.coverage, book.coverage) << trial;
      }
    }
  }
}

TEST(Greedy, KnownCover) {
  SightTable<2> table;  // Targets 0..9: the start sees 0, candidate 1 sees 1..5, 2 sees 4..9, 3 sees 1..3.
  table.targets = 10;
  table.candidates.assign(4, Vec<2>::Zero());
  table.rows.assign(4, {0});
  set(table.rows[0], 0);
  for (std::size_t t = 1; t <= 5; ++t) set(table.rows[1], t);
  for (std::size_t t = 4; t <= 9; ++t) set(table.rows[2], t);
  for (std::size_t t = 1; t <= 3; ++t) set(table.rows[3], t);
  set(table.rows[0], 10 + 1);  // From the start only candidate 1 is seen, from it candidate 2.
  set(table.rows[1], 10 + 2);
  const OracleRun anywhere = greedy_oracle(table);
  EXPECT_EQ(anywhere.places, (std::vector<std::size_t>{0, 2, 1}));  // Candidates 1 and 3 both add three: the smaller index.
  EXPECT_EQ(anywhere.coverage, (std::vector<double>{0.1, 0.7, 1.0}));
  EXPECT_EQ(anywhere.scans_to(0.99), 3);
  EXPECT_EQ(anywhere.scans_to(0.7), 2);
  const OracleRun walking = greedy_oracle(table, {.from_seen = true});
  EXPECT_EQ(walking.places, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(walking.coverage, (std::vector<double>{0.1, 0.6, 1.0}));
}

TEST(Greedy, WhatNobodySeesIsNeverCovered) {
  SightTable<2> table;
  table.targets = 4;
  table.candidates.assign(2, Vec<2>::Zero());
  table.rows.assign(2, {0});
  set(table.rows[0], 0);
  set(table.rows[1], 2);
  const OracleRun run = greedy_oracle(table);
  EXPECT_EQ(run.coverage, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(run.scans_to(0.99), std::nullopt);
}

TEST(ScansTo, CountsFromOne) {
  const std::vector<double> coverage{0.5, 0.9, 0.99, 1.0};
  EXPECT_EQ(scans_to(coverage, 0.4), 1);
  EXPECT_EQ(scans_to(coverage, 0.9), 2);
  EXPECT_EQ(scans_to(coverage, 0.99), 3);
  EXPECT_EQ(scans_to(coverage, 1.1), std::nullopt);
  EXPECT_EQ(scans_to({}, 0.0), std::nullopt);
}

TYPED_TEST(OracleOf, TableHoldsTheTrueLinesOfSight) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> world(pillars<Dim>(), 3.0);
  const SightTable<Dim> table = world.table(100000000, 12);  // All targets, in the order of the lattice.
  ASSERT_EQ(table.targets, world.reference.counted);
  EXPECT_EQ(table.candidates[0], world.start);
  std::size_t t = 0, seen = 0;
  for (std::size_t i = 0; i < world.reference.nodes.values.size(); ++i) {
    if (!world.reference.nodes[i].counts()) continue;
    const Vec<Dim> target = world.reference.nodes.window.position(i);
    for (std::size_t c = 0; c < table.candidates.size(); ++c) {
      const Vec<Dim>& from = table.candidates[c];
      EXPECT_EQ(table.sees(c, t), (target - from).norm() <= 3.0 && in_sight(world.truth, from, target));
      seen += table.sees(c, t) ? 1 : 0;
    }
    ++t;
  }
  EXPECT_GT(seen, 0U);
  for (std::size_t a = 0; a < table.candidates.size(); ++a)
    for (std::size_t b = 0; b < table.candidates.size(); ++b) EXPECT_EQ(table.sees_place(a, b), table.sees_place(b, a));
}

TYPED_TEST(OracleOf, OneScanSufficesInAnEmptyRoomAndTwoWithAWall) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> open(two_rooms<Dim>(0.3));
  EXPECT_EQ(greedy_oracle(open.table(2000, 50)).coverage, std::vector<double>{1.0});
  const World<Dim> wall(two_rooms<Dim>(5.0));
  const OracleRun run = greedy_oracle(wall.table(2000, 200));
  EXPECT_LT(run.coverage[0], 0.8);
  EXPECT_EQ(run.scans_to(0.99), 2);
}

TYPED_TEST(OracleOf, WhereCandidatesSeeTooLittleViewsAreAdded) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> world(pillars<Dim>());
  const SightTable<Dim> table = world.table(3000, 2);
  EXPECT_GT(table.candidates.size(), 3U);
  EXPECT_LE(table.candidates.size(), 6U);
  EXPECT_GT(greedy_oracle(world.table(3000, 100)).coverage.back(), 0.999);
}

TYPED_TEST(OracleOf, PlacesSeenBeforeAreInSightOfOneAnother) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> world(two_rooms<Dim>(5.0), 2.5);
  const SightTable<Dim> table = world.table(3000, 150);
  const OracleRun run = greedy_oracle(table, {.from_seen = true});
  EXPECT_GT(run.places.size(), 3U);
  for (std::size_t k = 1; k < run.places.size(); ++k)
    EXPECT_TRUE(std::any_of(run.places.begin(), run.places.begin() + static_cast<std::ptrdiff_t>(k),
                            [&](std::size_t p) { return table.sees_place(p, run.places[k]); }));
  EXPECT_TRUE(std::is_sorted(run.coverage.begin(), run.coverage.end()));
}

TYPED_TEST(OracleOf, SameForAnyNumberOfThreadsAnotherForAnotherSeed) {
  constexpr int Dim = TypeParam::value;
  const World<Dim> world(pillars<Dim>());
  const auto table = [&](int threads, std::int64_t seed) {
    const ThreadLimit limit(threads);
    return world.table(500, 20, seed);
  };
  const SightTable<Dim> one = table(1, 1);
  for (const int threads : {2, 7}) {
    EXPECT_EQ(table(threads, 1).rows, one.rows);
    EXPECT_EQ(table(threads, 1).candidates, one.candidates);
  }
  EXPECT_NE(table(2, 2).candidates, one.candidates);
  EXPECT_THROW((void)table(1, -1), Error);
}

}  // namespace
}  // namespace vantage
