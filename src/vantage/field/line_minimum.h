// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// Lines are taken side by side, this many at a time: a tile is rows of kTileLanes neighbours, row after row.
inline constexpr std::size_t kTileLanes = 16;

/// Stands for "none yet" among squared lattice distances: a square added to it is not below it, and no exact square reaches it.
template <class Real>
inline constexpr Real kFarSquare = sizeof(Real) == 4 ? Real(1LL << 25) : Real(1LL << 52);
/// Squared diagonals below leave every sum of squares exact in float.
inline constexpr double kExactSquare = 16777216.0;  // 2^24
/// Twice its square, and a few rows more, fit 16 bits.
inline constexpr int kMaxLimit = 120;

/// The distance transform of lines of `length`: value[i] <- min over j of value[j] + (i - j)^2, for whole squares that Real (float, double) holds
/// exactly, and kFarSquare. The nearest j never falls as i grows, so that a row searches only between what two rows farther apart have found (divide
/// and conquer): n log n at worst, whatever the distances.
template <class Real>
class LineMinimum {
 public:
  explicit LineMinimum(std::size_t length);
  /// `tile` and `out`: length x kTileLanes, apart from each other.
  void operator()(const Real* tile, Real* out) const;
  /// The same; also the row that is nearest, the first if several are.
  void operator()(const Real* tile, Real* out, std::int32_t* row) const;

 private:
  std::size_t length_;
  std::vector<Real> squares_;  // (j - i)^2 from j - i = -length on, as often as a vector has lanes.
};

/// Both sides at once: value > 0 is a node's squared distance to the nearest one that is < 0 and the other way round. Each becomes the least over j
/// of value[j] (0 across the boundary) + (i - j)^2. No value is above kMaxLimit^2; one that stands for "at least" stays so. Groups of rows that hold
/// nothing near are skipped.
class SignedLineMinimum {
 public:
  explicit SignedLineMinimum(std::size_t length) : length_(length) {}
  void operator()(const std::int16_t* tile, std::int16_t* out) const;

 private:
  std::size_t length_;
};

}  // namespace vantage
