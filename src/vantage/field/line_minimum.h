// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// Lines are taken side by side, this many at a time: a tile is rows of kLanes neighbours, row after row.
inline constexpr std::size_t kLanes = 16;

/// Stands for "none yet" among squared lattice distances; a square added to it stays at or above it.
inline constexpr float kFarSquare = 33554432.0F;  // 2^25
/// Squares below are exact in float, sums with another square included.
inline constexpr double kExactSquare = 16777216.0;  // 2^24
inline constexpr std::int16_t kFarShort = 16384;
inline constexpr int kMaxLimit = 120;  ///< kFarShort plus the square of this and a few rows more fits 16 bits.

/// The distance transform of lines of `length`: value[i] <- min over j of value[j] + (i - j)^2, for whole squares below kExactSquare and kFarSquare.
/// Exact. The nearest j never falls as i grows, so that a row searches only between what two rows farther apart have found (divide and conquer):
/// n log n at worst, whatever the distances.
class LineMinimum {
 public:
  explicit LineMinimum(std::size_t length);
  /// `tile` and `out`: length x kLanes, apart from each other.
  void operator()(const float* tile, float* out) const;

 private:
  std::size_t length_;
  std::vector<float> squares_;  // (j - i)^2 from j - i = 1 - length on, each four times.
};

/// Both sides at once, up to a limit: value > 0 is a node's squared distance to the nearest one that is < 0 and the other way round (kFarShort: none).
/// Each becomes the least over j of value[j] (0 across the boundary) + (i - j)^2; squares above limit^2 come out as anything above it.
class SignedLineMinimum {
 public:
  /// `limit`: at most kMaxLimit.
  SignedLineMinimum(std::size_t length, int limit) : length_(length), limit_(limit) {}
  void operator()(const std::int16_t* tile, std::int16_t* out) const;

 private:
  std::size_t length_;
  int limit_;
};

}  // namespace vantage
