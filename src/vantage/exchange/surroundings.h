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
  static constexpr int kSets = 64;

  Surroundings(const Level<Dim>& level, const LevelCell<Dim>& cell, int depth) : depth_(static_cast<std::uint32_t>(depth < 4 ? depth : 4)) {
    const auto near = level.around(cell.at);
    for (int i = 0; i < Level<Dim>::kNear; ++i) {
      const LevelCell<Dim>* n = near[static_cast<std::size_t>(i)];
      if (n != nullptr) exists_ |= 1U << static_cast<unsigned>(i);
      if (n != nullptr && (n->plane >= 0 || n->below_plane)) ++planes_;
      for (int k = 0; k < (1 << Dim); ++k) {
        int at = 0;
        for (int a = 0, rest = i, stride = 1; a < Dim; ++a, rest /= 3, stride *= 6) at += (2 * (rest % 3) + (k >> a & 1)) * stride;
        state_[static_cast<std::size_t>(at)] = n == nullptr ? kEmpty : n->known || n == &cell ? (n->mask >> k & 1) : kUnknown;
      }
    }
    for (int k = 0; k < (1 << Dim); ++k) state_[static_cast<std::size_t>(place(k))] = kUnknown;
  }
  /// Child k turned out to hold something, or nothing.
  void learn(int k, bool holds) {
    state_[static_cast<std::size_t>(place(k))] = holds ? kHolds : kEmpty;
    so_far_ |= (holds ? 1U : 0U) << static_cast<unsigned>(k);
  }
  /// Hashes for child k.
  [[nodiscard]] std::array<std::uint32_t, kInputs> contexts(int k) const {
    const int at = place(k);
    std::uint32_t by_size[3][3] = {};  // [how far apart: face, edge, corner][state]
    std::uint64_t all = 0, faces = 0, causal = 0;
    for (int i = 0; i < kTouching; ++i) {
      const auto state = state_[static_cast<std::size_t>(at + kOffset[static_cast<std::size_t>(i)])];
      ++by_size[kApart[static_cast<std::size_t>(i)]][state];
      all = all * 3 + state;
      causal = causal * 2 + (state == kHolds ? 1 : 0);
      if (kApart[static_cast<std::size_t>(i)] == 0) faces = faces * 3 + state;
    }
    std::uint64_t parents = 0;  // Those that touch the child.
    std::uint32_t touching = 0;
    for (int m = 1; m < (1 << Dim); ++m) {
      int i = 0;
      for (int a = 0, stride = 1; a < Dim; ++a, stride *= 3) i += (1 + ((m >> a & 1) != 0 ? ((k >> a & 1) != 0 ? 1 : -1) : 0)) * stride;
      const bool there = (exists_ >> static_cast<unsigned>(i) & 1U) != 0;
      parents = parents * 2 + (there ? 1 : 0);
      touching += there ? 1 : 0;
    }
    const auto number = static_cast<std::uint32_t>(k);
    std::array<std::uint32_t, kInputs> out{};
    out[0] = hash(0, all, 0);
    out[1] = hash(1, faces, by_size[1][kHolds] | by_size[1][kUnknown] << 4U | depth_ << 8U);
    out[2] = hash(2, parents << 26U | causal, 0);
    out[3] = hash(3, exists_, number);
    out[4] = hash(4, so_far_, number | static_cast<std::uint32_t>(std::popcount(exists_)) << 3U | depth_ << 8U);
    out[5] = hash(5, by_size[0][kHolds] | by_size[1][kHolds] << 3U | by_size[2][kHolds] << 7U | by_size[0][kUnknown] << 11U,
                  touching | planes_ << 3U | depth_ << 8U);
    for (int axis = 0; axis < Dim; ++axis) out[static_cast<std::size_t>(6 + axis)] = hash(6, layer(at, axis), static_cast<std::uint32_t>(axis));
    return out;
  }
  /// Which weights to use for child k.
  [[nodiscard]] int set(int k) const { return static_cast<int>(depth_) * 8 + k; }

 private:
  enum State : std::uint8_t { kEmpty, kHolds, kUnknown };
  static constexpr int kTouching = Level<Dim>::kNear - 1;

  /// Offsets of touching child cells, and in how many axes they differ, less one.
  static constexpr auto kSteps = [] {
    std::array<std::array<int, 2>, kTouching> steps{};
    int n = 0;
    for (int i = 0; i < Level<Dim>::kNear; ++i) {
      int offset = 0, apart = -1;
      for (int a = 0, rest = i, stride = 1; a < Dim; ++a, rest /= 3, stride *= 6) {
        offset += (rest % 3 - 1) * stride;
        apart += rest % 3 != 1 ? 1 : 0;
      }
      if (apart >= 0) steps[static_cast<std::size_t>(n++)] = {offset, apart};
    }
    return steps;
  }();
  static constexpr auto kOffset = [] {
    std::array<int, kTouching> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = kSteps[i][0];
    return out;
  }();
  static constexpr auto kApart = [] {
    std::array<int, kTouching> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = kSteps[i][1];
    return out;
  }();

  std::array<std::uint8_t, static_cast<std::size_t>(power(6, Dim))> state_{};
  std::uint32_t exists_ = 0, so_far_ = 0, planes_ = 0, depth_ = 0;

  [[nodiscard]] static int place(int k) {
    int at = 0;
    for (int a = 0, stride = 1; a < Dim; ++a, stride *= 6) at += (2 + (k >> a & 1)) * stride;
    return at;
  }
  /// The child cells within two steps that share the child's number along `axis`.
  [[nodiscard]] std::uint64_t layer(int at, int axis) const {
    int strides[Dim], n = 0;
    for (int a = 0, stride = 1; a < Dim; ++a, stride *= 6)
      if (a != axis) strides[n++] = stride;
    std::uint64_t states = 0;
    for (int i = 0; i < power(5, Dim - 1); ++i) {
      int to = at;
      for (int a = 0, rest = i; a + 1 < Dim; ++a, rest /= 5) to += (rest % 5 - 2) * strides[a];
      if (to != at) states = states * 3 + state_[static_cast<std::size_t>(to)];
    }
    return states;
  }
  [[nodiscard]] static std::uint32_t hash(std::uint32_t kind, std::uint64_t value, std::uint32_t more) {
    std::uint64_t h = (value + 0x51ed270b * (kind + 1)) * 0x9e3779b97f4a7c15ULL;
    h = (h ^ h >> 32U ^ more) * 0xd6e8feb86659fd93ULL;
    return static_cast<std::uint32_t>(h >> 32U);
  }
};

}  // namespace vantage
