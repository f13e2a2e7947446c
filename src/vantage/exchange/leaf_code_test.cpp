// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/leaf_code.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/exchange/plane_code.h"

namespace vantage {
namespace {

template <class Dimension>
class LeafCodes : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LeafCodes, Dimensions);

/// Leaves as wild as the format allows, around the origin or far from it: sites below planes, planes below planes, any heights.
template <int Dim>
Leaves<Dim> random_leaves(std::uint64_t seed, std::size_t planes, std::size_t cells, std::uint32_t width) {
  Random random(seed);
  const auto base = seed % 2 == 0 ? ExchangeLattice<Dim>::kOrigin - width / 2 : static_cast<std::uint32_t>(random.below((1U << 31U) - width));
  const auto cell = [&] {
    CellNumber<Dim> at;
    for (std::uint32_t& a : at) a = base + static_cast<std::uint32_t>(random.below(width));
    return at;
  };
  std::map<std::pair<int, CellNumber<Dim>>, PlaneLeaf<Dim>> by_cell;
  for (std::size_t i = 0; i < planes; ++i) {
    PlaneLeaf<Dim> plane{.cell = cell()};
    plane.level = PlaneLeaf<Dim>::kLowest + static_cast<int>(random.below(PlaneLeaf<Dim>::kHighest));
    for (std::uint32_t& a : plane.cell) a >>= plane.level;
    plane.axis = static_cast<int>(random.below(Dim));
    for (std::int32_t& h : plane.height) h = static_cast<std::int32_t>(random.below(i % 7 == 0 ? 100000 : 40)) - 20;
    by_cell[{plane.level, plane.cell}] = plane;
  }
  std::map<CellNumber<Dim>, std::uint8_t> sites;
  for (std::size_t i = 0; i < cells; ++i) sites[cell()] = static_cast<std::uint8_t>(1 + random.below(3));
  Leaves<Dim> leaves;
  for (const auto& [key, plane] : by_cell) leaves.planes.push_back(plane);
  for (const auto& [at, mask] : sites) leaves.sites.push_back({at, mask});
  return leaves;
}

template <int Dim>
LeafCounts counts(const Leaves<Dim>& leaves) {
  return {leaves.planes.size(), leaves.sites.size()};
}

TYPED_TEST(LeafCodes, ReadBackInTheirOrderWhateverOrderTheyCameIn) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Leaves<Dim> leaves = random_leaves<Dim>(seed, seed % 5 * 20, seed % 3 * 200, seed % 4 == 0 ? 1U << 29U : 40);
    const std::string bytes = encode_leaves(leaves);
    sort_leaves(leaves);
    EXPECT_EQ(encode_leaves(leaves), bytes);
    EXPECT_EQ(decode_leaves<Dim>(bytes, counts(leaves), "code"), leaves);
  }
}

TYPED_TEST(LeafCodes, NothingIsNoBytes) {
  constexpr int Dim = TypeParam::value;
  EXPECT_EQ(encode_leaves(Leaves<Dim>{}), "");
  EXPECT_EQ(decode_leaves<Dim>("", {}, "code"), Leaves<Dim>{});
}

TYPED_TEST(LeafCodes, WrongCountsAndWrongBytesEndInAnErrorOrInLeaves) {
  constexpr int Dim = TypeParam::value;
  const Leaves<Dim> leaves = random_leaves<Dim>(4, 20, 300, 64);
  const std::string bytes = encode_leaves(leaves);
  const LeafCounts right = counts(leaves);
  EXPECT_THROW(static_cast<void>(decode_leaves<Dim>(bytes, {right.planes, right.cells - 1}, "code")), Error);
  EXPECT_THROW(static_cast<void>(decode_leaves<Dim>(bytes, {right.planes, right.cells + 1}, "code")), Error);
  EXPECT_THROW(static_cast<void>(decode_leaves<Dim>(bytes.substr(0, bytes.size() / 2), right, "code")), Error);
  EXPECT_THROW(static_cast<void>(decode_leaves<Dim>(bytes + std::string(8, 'x'), right, "code")), Error);
  EXPECT_THROW(static_cast<void>(decode_leaves<Dim>(bytes, {}, "code")), Error);
  EXPECT_THROW(static_cast<void>(decode_leaves<Dim>("", {0, 4000000000U}, "code")), Error);
  EXPECT_THROW(static_cast<void>(decode_leaves<Dim>("", {4000000000U, 0}, "code")), Error);
  int survived = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::string wrong = bytes;
    wrong[i] = static_cast<char>(wrong[i] ^ 0x55);
    try {
      const Leaves<Dim> read = decode_leaves<Dim>(wrong, right, "code");
      EXPECT_EQ(read.sites.size(), right.cells);
      for (const Patch<Dim>& patch : patches<Dim>({1.0}, read)) EXPECT_TRUE(patch.bounds().low.allFinite());
      ++survived;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
    }
  }
  EXPECT_LT(survived, static_cast<int>(bytes.size() / 3));
}

/// As predictable as leaves can be: the densest code that is written must be one that is read.
TYPED_TEST(LeafCodes, AFullBlockOfCellsIsReadBackAndNotTakenForTooShort) {
  constexpr int Dim = TypeParam::value;
  const std::uint32_t width = Dim == 2 ? 256 : 32;
  Leaves<Dim> leaves;
  for (std::size_t i = 0; i < (Dim == 2 ? width * width : width * width * width); ++i) {
    CellNumber<Dim> at;
    std::size_t rest = i;
    for (std::uint32_t& a : at) {
      a = ExchangeLattice<Dim>::kOrigin + static_cast<std::uint32_t>(rest % width);
      rest /= width;
    }
    leaves.sites.push_back({at, 3});
  }
  const std::string code = encode_leaves(leaves);
  EXPECT_GT(leaves.sites.size(), 30 * code.size());
  EXPECT_EQ(decode_leaves<Dim>(code, counts(leaves), "here").sites.size(), leaves.sites.size());
}

/// Few bytes cannot keep a reader busy.
TYPED_TEST(LeafCodes, LeavesThatNoCodeIsShortEnoughForAreRefusedUnread) {
  constexpr int Dim = TypeParam::value;
  try {
    (void)decode_leaves<Dim>(std::string(200, '\0'), {500000, 12}, "here");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "here: 500012 leaves in 200 bytes: no code is so short");
  }
}

TYPED_TEST(LeafCodes, RefuseWhatTheFormatCannotSay) {
  constexpr int Dim = TypeParam::value;
  CellNumber<Dim> far{};
  far[0] = 1U << 31U;
  EXPECT_THROW(static_cast<void>(encode_leaves(Leaves<Dim>{{}, {{far, 1}}})), Error);
  EXPECT_THROW(static_cast<void>(encode_leaves(Leaves<Dim>{{}, {{CellNumber<Dim>{}, 0}}})), Error);
  EXPECT_THROW(static_cast<void>(encode_leaves(Leaves<Dim>{{{.cell = {}, .level = 0}}, {}})), Error);
  EXPECT_THROW(static_cast<void>(encode_leaves(Leaves<Dim>{{{.cell = {}, .level = 2}, {.cell = {}, .level = 2}}, {}})), Error);
}

TYPED_TEST(LeafCodes, APlaneMeetsTheChildrenThatItsPieceReaches) {
  constexpr int Dim = TypeParam::value;
  const ExchangeLattice<Dim> lattice{0.5};
  for (const PlaneLeaf<Dim>& plane : random_leaves<Dim>(6, 200, 0, 64).planes) {
    const PlanePiece<Dim> piece = plane_piece(lattice, plane);
    const std::uint8_t mask = met_children<Dim>(plane, plane.cell, plane.level);
    if (piece.region.count == 0) continue;
    const Patch<Dim> patch = piece_patch(piece);
    for (const Vec<Dim>& corner : patch.corners()) {
      EXPECT_LT(lattice.box(plane.cell, plane.level).distance(corner), 1e-6);
      bool reached = false;
      for (int k = 0; k < (1 << Dim); ++k)
        reached = reached || ((mask >> k & 1) != 0 && lattice.box(child_of<Dim>(plane.cell, k), plane.level - 1).distance(corner) < 1e-6);
      EXPECT_TRUE(reached);
    }
  }
}

TYPED_TEST(LeafCodes, ExtendedHeightsAreTheSamePlaneElsewhere) {
  constexpr int Dim = TypeParam::value;
  const ExchangeLattice<Dim> lattice{1.0};
  Random random(8);
  for (const PlaneLeaf<Dim>& known : random_leaves<Dim>(8, 100, 0, 64).planes) {
    if (std::any_of(known.height.begin(), known.height.end(), [](std::int32_t h) { return std::abs(h) > 100; })) continue;
    PlaneLeaf<Dim> other = known;
    other.level = PlaneLeaf<Dim>::kLowest + static_cast<int>(random.below(PlaneLeaf<Dim>::kHighest));
    for (int a = 0; a < Dim; ++a)
      other.cell[a] =
          static_cast<std::uint32_t>(((std::int64_t{known.cell[a]} << known.level) >> other.level) + static_cast<std::int64_t>(random.below(3)) - 1);
    other.height = extended_heights<Dim>(known, other.cell, other.level);
    // Heights over the origin of the other cell, as plane_piece has them, differ by the rounding of each number alone.
    const PlanePiece<Dim> a = plane_piece(lattice, known), b = plane_piece(lattice, other);
    const double off = a.frame.axes.col(Dim - 1).dot(b.frame.origin - a.frame.origin);
    EXPECT_LT(std::abs(off), 1.01 * (0.5 + 0.25 * (Dim - 1)) / PlaneLeaf<Dim>::kSteps);
  }
}

}  // namespace
}  // namespace vantage
