// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/planner/boundary_metric.h"

namespace vantage {

/// Eq. (1) without line of sight, at many places: boundary_metric() with the same options, by a tree over the elements. What turns its back to a
/// place is left out whole; what all faces it and looks small from there is summed at once, by its first two moments (Barnes and Hut, Nature 324,
/// 1986); the rest is summed element by element, several at a time, in floats relative to their group.
template <int Dim>
  requires SpatialDim<Dim>
class PlainSum {
 public:
  /// `rays` gives w. A group counts as small where its radius is below `options.tree_angle` times its distance: the relative error is of the order of
  /// its square for one group and far less for a sum; 0: element by element. Cost: n log n for n elements; bench_decision measures it.
  PlainSum(std::span<const BoundaryElement<Dim>> elements, const RayMarch<Dim>& rays, const PlannerOptions& options);

  /// E(z) [m^(Dim-1)].
  [[nodiscard]] double at(const Vec<Dim>& z) const;

 private:
  struct Group {
    Vec<Dim> center, axis;                      // Of its box; mean of the normals, of length 1.
    double radius = 0.0;                        // Of its elements round the center [m].
    double cos_spread = 1.0, sin_spread = 0.0;  // Of the normals round the axis.
    Vec<Dim> flux;                              // Sum of A n.
    Eigen::Matrix<double, Dim, Dim> moment;     // Sum of A (y - center) n^T.
    std::uint32_t begin = 0, end = 0;           // Elements of a leaf.
    std::uint32_t parts = 0;                    // Index of the first of its two parts; 0: a leaf.
  };
  enum class Side { front, back, both };

  void build(std::uint32_t group, std::span<BoundaryElement<Dim>> elements);
  void measure(Group& group, std::span<const BoundaryElement<Dim>> elements) const;
  void append(const Vec<Dim>& offset, const BoundaryElement<Dim>& element);
  [[nodiscard]] Side side(const Group& group, const Vec<Dim>& offset, double distance) const;
  [[nodiscard]] double from_afar(const Group& group, const Vec<Dim>& offset, double distance) const;
  [[nodiscard]] double one_by_one(const Group& group, const Vec<Dim>& offset) const;

  double angle_, power_;  // Every term is A n.d |d|^-power.
  bool absolute_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> roots_;
  std::array<std::vector<float>, Dim> place_, normal_;  // Of the elements, leaf by leaf, places relative to its center; a few of area 0 fill up.
  std::vector<float> area_;
};

/// Eq. (1) at many places: by a tree, or with line of sight element by element. What it is made from must outlive it.
template <int Dim>
  requires SpatialDim<Dim>
class BoundarySum {
 public:
  BoundarySum(std::span<const BoundaryElement<Dim>> elements, const RayMarch<Dim>& rays, const PlannerOptions& options)
      : elements_(elements), rays_(rays), options_(options) {
    if (!options.line_of_sight) plain_.emplace(elements, rays, options);
  }
  [[nodiscard]] double at(const Vec<Dim>& z) const { return plain_ ? plain_->at(z) : boundary_metric<Dim>(elements_, rays_, z, options_); }

 private:
  std::span<const BoundaryElement<Dim>> elements_;
  const RayMarch<Dim>& rays_;
  const PlannerOptions& options_;
  std::optional<PlainSum<Dim>> plain_;
};

}  // namespace vantage
