// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "vantage/field/seen_set.h"
#include "vantage/visibility/depth_pyramid.h"

namespace vantage {

/// Where a depth image was taken and how far it reaches.
template <int Dim>
struct Viewpoint {
  Vec<Dim> origin = Vec<Dim>::Zero();  ///< [m]
  double max_range = kInfinity;        ///< [m]
};

/// Whether the place at `offset` from the viewpoint is in range and not behind the image; the viewpoint itself always is seen.
/// The definition, and the reference for seen_from().
template <int Dim>
[[nodiscard]] bool sees(const DepthImage<Dim>& image, double max_range, const Vec<Dim>& offset) {
  double square = offset[Dim - 1] * offset[Dim - 1];
  for (int a = Dim - 2; a >= 0; --a) square = offset[a] * offset[a] + square;
  if (square > max_range * max_range || square == 0.0) return square == 0.0;
  const auto depth = static_cast<double>(image[image.pixel(offset)]);
  return square <= depth * depth;
}

/// The nodes of `window` that are seen: exactly those that sees() says, found by whole blocks. A least-and-greatest pyramid of the image decides
/// blocks of nodes at once, and only those that the boundary crosses are opened: cost follows the boundary, not the volume. Same bits for any
/// number of threads.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] SeenSet<Dim> seen_from(const DepthImage<Dim>& image, const Viewpoint<Dim>& viewpoint, const Grid<Dim>& window);

/// A coarse answer first, refined where needed (paper Sec. IV-B, after Tsai et al. [22]): cubes of nodes that are all seen, or undecided; what
/// neither holds is hidden. Every level's bounds hold, and refining never widens them; past the last level seen_from() decides node by node.
template <int Dim>
  requires SpatialDim<Dim>
class GradualView {
 public:
  /// The pyramid must outlive this. The first cubes have 128 nodes a side.
  GradualView(const DepthPyramid<Dim>& pyramid, const Viewpoint<Dim>& viewpoint, const Grid<Dim>& window);

  /// Halves the undecided cubes. False, and nothing happens, if they are single blocks of SeenSet already. Cost: the undecided cubes.
  bool refine();

  [[nodiscard]] std::int32_t side() const { return SeenSet<Dim>::kSide << level_; }     ///< Nodes along an edge of an undecided cube.
  [[nodiscard]] const std::vector<Grid<Dim>>& seen() const { return seen_; }            ///< Cubes, as far as they lie in the window.
  [[nodiscard]] const std::vector<Grid<Dim>>& undecided() const { return undecided_; }  ///< The same.
  [[nodiscard]] std::size_t seen_at_least() const { return least_; }                    ///< Nodes of the window.
  [[nodiscard]] std::size_t seen_at_most() const { return least_ + open_; }             ///< Nodes of the window.

 private:
  static constexpr int kFirstLevel = 4;
  void judge(std::vector<Grid<Dim>> cubes);

  const DepthPyramid<Dim>& pyramid_;
  Viewpoint<Dim> viewpoint_;
  Grid<Dim> window_;
  int level_ = kFirstLevel;
  std::vector<Grid<Dim>> seen_, undecided_;
  std::size_t least_ = 0, open_ = 0;
};

}  // namespace vantage
