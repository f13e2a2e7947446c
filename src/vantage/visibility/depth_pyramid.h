// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/visibility/depth_image.h"

namespace vantage {

/// Least and greatest ranges over ever larger squares of a depth image: bounds over any set of directions for a few look-ups.
template <int Dim>
  requires SpatialDim<Dim>
class DepthPyramid {
 public:
  struct Bounds {
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();
    void extend(const Bounds& other) {
      low = std::min(low, other.low);
      high = std::max(high, other.high);
    }
  };

  /// The image must outlive the pyramid and not change. Cost: one pass over the image.
  explicit DepthPyramid(const DepthImage<Dim>& image);

  [[nodiscard]] const DepthImage<Dim>& image() const { return image_; }
  /// Bounds of the ranges in all directions to places of `box` (relative to the viewpoint): never too tight, at most a few pixels too wide.
  /// Nothing (low > high) for the viewpoint alone.
  [[nodiscard]] Bounds over(const Box<Dim>& box) const;
  /// Bounds of the pixels of a face in `area`, which is not empty: never too tight, at most a square of half its longest side too wide.
  [[nodiscard]] Bounds over(int face, const typename DepthImage<Dim>::Rectangle& area) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Squares of 2^shift pixels a side, per face, the last axis fastest.
  struct Level {
    int shift, columns, rows;
    std::vector<Bounds> squares;
  };
  template <class Source>
  Level reduce(const Level& fine, int factor, const Source& source) const;

  const DepthImage<Dim>& image_;
  std::vector<Level> levels_;  ///< From 4 x 4 pixels on.
};

}  // namespace vantage
