// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/audit/box_tree.h"
#include "vantage/geometry/patch.h"
#include "vantage/world/scene.h"

namespace vantage {

/// The poles and wires of a scene, and how much of what was observed of them a reconstruction has.
template <int Dim>
  requires SpatialDim<Dim>
class ThinParts {
 public:
  /// Places all over the parts named "pole" and "wire", about 300 a square metre (2D: a metre), from a fixed seed.
  explicit ThinParts(const Scene<Dim>& scene);

  [[nodiscard]] bool empty() const { return places_.empty(); }
  /// Places within 5 cm of a return count as observed from now on.
  void observe(std::span<const Vec<Dim>> returns);
  /// Share of the observed places that the surface is within 10 cm of [1]; nullopt if nothing was observed.
  [[nodiscard]] std::optional<double> recall(std::span<const Patch<Dim>> surface) const;

 private:
  std::vector<Vec<Dim>> places_;
  BoxTree<Dim> tree_;
  std::vector<bool> observed_;
};

}  // namespace vantage
