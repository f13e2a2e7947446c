// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>

#include "vantage/exchange/level.h"

namespace vantage {

/// What is known of the cells around the children of one cell: the six child cells along each axis that it and its neighbours have. From them come
/// the contexts that predict which children hold something.
template <int Dim>
class Surroundings {
 public:
  static constexpr int kInputs = 6 + Dim;
  static constexpr int kSets = 40;

  Surroundings(const Level<Dim>& level, const LevelCell<Dim>& cell, int depth) : depth_(static_cast<std::uint32_t>(depth < 4 ? depth : 4)) {
    const auto near = level.around(cell.at);
    for (int i = 0; i < Level<Dim>::kNear; ++i) {
      const LevelCell<Dim>* n = near[static_cast<std::size_t>(i)];
      if (n == nullptr) continue;
      exists_ |= 1U << static_cast<unsigned>(i);
      planes_ += n->plane >= 0 ? 1 : 0;
      place(i % 3, i / 3 % 3, i / 9, n->known ? n->mask : 0, holds_);
      if (!n->known) place(i % 3, i / 3 % 3, i / 9, kAllChildren, unknown_);
    }
  }
  /// Child k turned out to hold something, or nothing.
  void learn(int k, bool holds) {
    const unsigned bit = bit_of(k);
    const auto slice = static_cast<std::size_t>(slice_of(k));
    unknown_[slice] &= ~(std::uint64_t{1} << bit);
    holds_[slice] |= std::uint64_t{holds} << bit;
    so_far_ |= static_cast<std::uint32_t>(holds) << static_cast<unsigned>(k);
  }
  /// Hashes for child k.
  [[nodiscard]] std::array<std::uint32_t, kInputs> contexts(int k) const {
    const unsigned bit = bit_of(k);
    const int slice = slice_of(k);
    std::uint64_t all = 0, held = 0, faces = 0;
    std::uint32_t face_count = 0, edge_count = 0, corner_count = 0, face_unknown = 0, edge_unknown = 0;
    for (int d = -kDeep; d <= kDeep; ++d) {  // The three by three around, by slices.
      const std::uint64_t h = holds_[static_cast<std::size_t>(slice + d)] >> (bit - 7),
                          u = unknown_[static_cast<std::size_t>(slice + d)] >> (bit - 7);
      const std::uint64_t face = d == 0 ? kPlus : kMiddle, edge = d == 0 ? kCross : kPlus, corner = d == 0 ? 0 : kCross;
      all = (all ^ (h & kSquare) ^ (u & kSquare) << 20U) * kMix;
      held = (held << 3U) ^ (h & kSquare);
      faces = (faces ^ (h & face) ^ (u & face) << 20U) * kMix;
      face_count += count(h & face);
      edge_count += count(h & edge);
      corner_count += count(h & corner);
      face_unknown += count(u & face);
      edge_unknown += count(u & edge);
    }
    const std::uint32_t parents = touching_parents(k);
    const auto number = static_cast<std::uint32_t>(k);
    std::array<std::uint32_t, kInputs> out{};
    out[0] = hash(all, 0);
    out[1] = hash(faces, edge_count | edge_unknown << 4U | depth_ << 8U);
    out[2] = hash(held, parents);
    out[3] = hash(exists_, number);
    out[4] = hash(so_far_, number | count(exists_) << 3U | depth_ << 8U);
    out[5] = hash(face_count | edge_count << 3U | corner_count << 7U | face_unknown << 11U, count(parents) | planes_ << 3U | depth_ << 8U);
    out[6] = hash(((holds_[static_cast<std::size_t>(slice)] >> (bit - 14)) & kWide) * kMix ^
                      ((unknown_[static_cast<std::size_t>(slice)] >> (bit - 14)) & kWide),
                  1);
    upright(bit, slice, out);
    return out;
  }
  /// Which weights to use for child k.
  [[nodiscard]] int set(int k) const { return static_cast<int>(depth_) * 8 + k; }

 private:
  // Child cells are bits: x + 6 y of a slice of given z.
  static constexpr int kDeep = Dim - 2;
  static constexpr std::uint64_t kMix = 0x9e3779b97f4a7c15ULL;
  static constexpr std::uint64_t kMiddle = 1U << 7U, kPlus = 1U << 1U | 1U << 6U | 1U << 8U | 1U << 13U,
                                 kCross = 1U << 0U | 1U << 2U | 1U << 12U | 1U << 14U;
  static constexpr std::uint64_t kSquare = kMiddle | kPlus | kCross;
  static constexpr std::uint64_t kWide = 0x1fULL * (1ULL | 1ULL << 6U | 1ULL << 12U | 1ULL << 18U | 1ULL << 24U) & ~(1ULL << 14U);
  static constexpr unsigned kAllChildren = (1U << (1U << Dim)) - 1U;

  std::array<std::uint64_t, static_cast<std::size_t>(power(6, Dim - 2))> holds_{}, unknown_{};
  std::uint32_t exists_ = 0, so_far_ = 0, planes_ = 0, depth_ = 0;

  [[nodiscard]] static unsigned bit_of(int k) { return 14U + (static_cast<unsigned>(k) & 1U) + 6U * (static_cast<unsigned>(k) >> 1U & 1U); }
  [[nodiscard]] static int slice_of(int k) { return kDeep * (2 + (k >> 2)); }
  [[nodiscard]] static std::uint32_t count(std::uint64_t bits) { return static_cast<std::uint32_t>(std::popcount(bits)); }
  /// Puts the children of neighbour (x, y, z), each from 0 to 2, into `planes`.
  static void place(int x, int y, int z, unsigned mask, std::array<std::uint64_t, static_cast<std::size_t>(power(6, Dim - 2))>& planes) {
    for (int half = 0; half <= kDeep; ++half) {
      const std::uint64_t four = mask >> (4 * half) & 15U;
      planes[static_cast<std::size_t>(kDeep * (2 * z + half))] |= ((four & 3U) | (four & 12U) << 4U) << static_cast<unsigned>(2 * x + 12 * y);
    }
  }
  /// One bit for each neighbour of the cell that touches child k.
  [[nodiscard]] std::uint32_t touching_parents(int k) const {
    static constexpr auto kTouching = [] {
      std::array<std::uint32_t, 1U << Dim> masks{};
      for (int child = 0; child < (1 << Dim); ++child)
        for (int i = 0; i < Level<Dim>::kNear; ++i) {
          bool touches = i != (Level<Dim>::kNear - 1) / 2;
          for (int a = 0, rest = i; a < Dim; ++a, rest /= 3) touches = touches && (rest % 3 == 1 || rest % 3 == ((child >> a & 1) != 0 ? 2 : 0));
          masks[static_cast<std::size_t>(child)] |= static_cast<std::uint32_t>(touches) << static_cast<unsigned>(i);
        }
      return masks;
    }();
    return exists_ & kTouching[static_cast<std::size_t>(k)];
  }
  /// The cells within two steps that share the child's x, or its y; in the plane they are a column and a row.
  void upright(unsigned bit, int slice, std::array<std::uint32_t, kInputs>& out) const {
    std::uint64_t same_x = 0, same_y = 0;
    for (int d = -2 * kDeep; d <= 2 * kDeep; ++d) {
      const std::uint64_t h = holds_[static_cast<std::size_t>(slice + d)] >> (bit - 14),
                          u = unknown_[static_cast<std::size_t>(slice + d)] >> (bit - 14);
      constexpr std::uint64_t kColumn = 1ULL << 2U | 1ULL << 8U | 1ULL << 14U | 1ULL << 20U | 1ULL << 26U, kRow = 31ULL << 12U;
      same_x = (same_x ^ (h & kColumn) ^ (u & kColumn) << 30U) * kMix;
      same_y = (same_y ^ (h & kRow) ^ (u & kRow) << 30U) * kMix;
    }
    out[kInputs - 1] = hash(same_x, 2);
    if (kDeep > 0) out[kInputs - 2] = hash(same_y, 3);
  }
  [[nodiscard]] static std::uint32_t hash(std::uint64_t value, std::uint32_t more) {
    std::uint64_t h = (value + 0x51ed270b) * kMix;
    h = (h ^ h >> 32U ^ more) * 0xd6e8feb86659fd93ULL;
    return static_cast<std::uint32_t>(h >> 32U);
  }
};

}  // namespace vantage
