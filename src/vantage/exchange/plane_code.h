// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

#include "vantage/exchange/cell_table.h"
#include "vantage/exchange/leaves.h"
#include "vantage/exchange/level.h"
#include "vantage/exchange/predictor.h"

namespace vantage {

/// The heights that `known`, a plane elsewhere, has over the face of `cell` of `level`, rounded to whole steps: the same plane there, if both have
/// one. Integers only.
template <int Dim>
[[nodiscard]] std::array<std::int32_t, Dim> extended_heights(const PlaneLeaf<Dim>& known, const CellNumber<Dim>& cell, int level);

/// Children of `cell` (of `level`, inside the plane's own or equal to it) that the plane meets.
template <int Dim>
[[nodiscard]] std::uint8_t met_children(const PlaneLeaf<Dim>& plane, const CellNumber<Dim>& cell, int level);

/// Codes which cells are planes, and which planes: each as its difference to one that a neighbouring cell has, or to the last one.
template <int Dim>
class PlaneCode {
 public:
  template <class Coder>
  bool code_flag(Coder& coder, const Level<Dim>& level, const LevelCell<Dim>& cell, int l, bool flag) {
    near_.clear();
    std::uint32_t exist = 0, plane = 0, earlier = 0;
    for (const LevelCell<Dim>* n : level.around(cell.at)) {
      earlier *= 2;
      if (n == nullptr) continue;
      if (!n->below_plane) ++exist;
      if (n->plane < 0) continue;
      ++plane;
      ++earlier;
      if (near_.size() < kCandidates && std::find(near_.begin(), near_.end(), n->plane) == near_.end()) near_.push_back(n->plane);
    }
    const auto depth = static_cast<std::uint32_t>(l);
    return code_bit(coder, flags_, flag, std::array{depth | plane << 4U, depth | exist << 4U | (plane != 0 ? 1024U : 0U), earlier});
  }

  /// Does the plane's cell hold nothing else?
  template <class Coder>
  bool code_bare(Coder& coder, int l, bool bare) {
    return code_bit(coder, numbers_, bare, std::array{1U << 25U | static_cast<std::uint32_t>(l)});
  }

  /// Right after the flag of the same cell.
  template <class Coder>
  void code_plane(Coder& coder, PlaneLeaf<Dim>& plane) {
    if (!planes_.empty()) near_.push_back(static_cast<std::int32_t>(planes_.size()) - 1);
    std::size_t which = best(plane);
    std::size_t i = 0;
    const auto count = static_cast<std::uint32_t>(near_.size());
    while (i < near_.size() && code_bit(coder, numbers_, i < which, std::array{1U << 24U | count << 8U | static_cast<std::uint32_t>(i)})) ++i;
    std::array<std::int32_t, Dim> guess{};
    std::uint32_t kind = 4;
    if (i < near_.size()) {
      const PlaneLeaf<Dim>& known = planes_[static_cast<std::size_t>(near_[i])];
      plane.axis = known.axis;
      guess = extended_heights<Dim>(known, plane.cell, plane.level);
      kind = i + 1 == near_.size() ? 3 : 0;
    } else {
      std::int32_t axis = 0;
      while (axis + 1 < Dim && code_bit(coder, numbers_, axis < plane.axis, std::array{1U << 26U | static_cast<std::uint32_t>(axis)})) ++axis;
      plane.axis = axis;
    }
    for (std::uint32_t k = 0; k < Dim; ++k) {
      std::int32_t& height = plane.height[k];
      const std::int32_t difference =
          code_number(coder, numbers_, height - guess[k], kind << 8U | k << 4U | (kind == 4 ? static_cast<std::uint32_t>(plane.level) : 0U));
      height = guess[k] + difference;
      if (kind < 2 && difference != 0) ++kind;  // Once the prediction failed, it will again.
    }
    planes_.push_back(plane);
  }

 private:
  static constexpr std::size_t kCandidates = 6;
  std::vector<PlaneLeaf<Dim>> planes_;
  std::vector<std::int32_t> near_;  ///< Planes that may predict the next one.
  Predictor flags_{3, 16, 1}, numbers_{1, 18, 1};

  /// The candidate that predicts best; near_.size() if none has the axis.
  [[nodiscard]] std::size_t best(const PlaneLeaf<Dim>& plane) const {
    std::size_t which = near_.size();
    std::int64_t least = 40 * (std::int64_t{1} << plane.level);
    for (std::size_t i = 0; i < near_.size(); ++i) {
      const PlaneLeaf<Dim>& known = planes_[static_cast<std::size_t>(near_[i])];
      if (known.axis != plane.axis) continue;
      const auto guess = extended_heights<Dim>(known, plane.cell, plane.level);
      std::int64_t apart = 0;
      for (std::size_t k = 0; k < Dim; ++k) apart += std::abs(std::int64_t{guess[k]} - plane.height[k]);
      if (apart < least) least = apart, which = i;
    }
    return which;
  }
};

/// Contexts of the sites of a cell of level 0.
template <int Dim>
class SiteContexts {
 public:
  SiteContexts(const Level<Dim>& level, const LevelCell<Dim>& cell);
  [[nodiscard]] std::array<std::uint32_t, 5> corner() const;
  [[nodiscard]] std::array<std::uint32_t, 5> center() const;

 private:
  static constexpr int kNear = Level<Dim>::kNear;
  std::uint64_t masks_ = 0;                                                           ///< Known neighbours, two bits each.
  std::uint32_t exists_ = 0;                                                          ///< A bit a neighbour.
  std::uint32_t low_centers_ = 0, low_corners_ = 0, low_cells_ = 0, high_cells_ = 0;  ///< Of those that touch the corner, or the centre.
};

}  // namespace vantage
