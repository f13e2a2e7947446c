// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "vantage/field/grid.h"

namespace vantage {

/// Floats on the nodes near something: blocks of 4^Dim that hold nothing but `rest` cost four bytes.
template <int Dim>
  requires SpatialDim<Dim>
class BlockValues {
 public:
  static constexpr std::int32_t kSide = 4;

  BlockValues() = default;
  BlockValues(const Grid<Dim>& window, float rest) : blocks_(window), rest_(rest) {
    blocks_.extent = (window.extent.array() + (kSide - 1)) / kSide;
    slot_.assign(blocks_.size(), 0);
    values_.assign(kNodes, rest);  // What empty blocks show.
  }
  [[nodiscard]] float operator()(const Index<Dim>& local) const { return values_[slot_[block(local)] * kNodes + offset(local)]; }
  /// To write to; other references end.
  [[nodiscard]] float& at(const Index<Dim>& local) {
    std::uint32_t& slot = slot_[block(local)];
    if (slot == 0) {
      slot = static_cast<std::uint32_t>(values_.size() / kNodes);
      values_.resize(values_.size() + kNodes, rest_);
    }
    return values_[slot * kNodes + offset(local)];
  }
  /// The values from `local` along axis 0 to the end of its block; null if all are `rest`.
  [[nodiscard]] const float* run(const Index<Dim>& local) const {
    const std::uint32_t slot = slot_[block(local)];
    return slot == 0 ? nullptr : values_.data() + slot * kNodes + offset(local);
  }
  [[nodiscard]] std::size_t bytes() const { return slot_.capacity() * sizeof(std::uint32_t) + values_.capacity() * sizeof(float); }

 private:
  static constexpr std::size_t kNodes = std::size_t{1} << (2 * Dim);

  static constexpr auto kUnsignedSide = static_cast<std::uint32_t>(kSide);  // Plain shifts.

  [[nodiscard]] std::size_t block(const Index<Dim>& local) const {
    std::size_t i = 0;
    for (int a = Dim - 1; a >= 0; --a) i = i * static_cast<std::size_t>(blocks_.extent[a]) + static_cast<std::uint32_t>(local[a]) / kUnsignedSide;
    return i;
  }
  [[nodiscard]] static std::size_t offset(const Index<Dim>& local) {
    std::size_t i = 0;
    for (int a = Dim - 1; a >= 0; --a) i = i * kUnsignedSide + static_cast<std::uint32_t>(local[a]) % kUnsignedSide;
    return i;
  }

  Grid<Dim> blocks_;
  float rest_ = 0.0F;
  std::vector<std::uint32_t> slot_;
  std::vector<float> values_;
};

}  // namespace vantage
