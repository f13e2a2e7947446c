// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <span>
#include <vector>

#include "vantage/geometry/patch.h"
#include "vantage/scan/scan.h"

namespace vantage {

/// A row of pixels, or the rest of one: directions `base + w along`, not of unit length.
template <int Dim>
struct PixelRun {
  Vec<Dim> base, along;
  double column = 0.5;      ///< Of the first pixel's centre, in pixels.
  double resolution = 1.0;  ///< Of the image.

  /// w of the k-th pixel.
  [[nodiscard]] double offset(int k) const { return (column + k) * 2.0 / resolution - 1.0; }
  /// Unit direction of the k-th pixel's centre, the same bits as DepthImage::direction().
  [[nodiscard]] Vec<Dim> direction(int k) const { return (base + offset(k) * along).normalized(); }
};

/// Range of the first occluder per direction: a cube map (in 2D the four sides of a square), so that a look-up needs no trigonometry.
template <int Dim>
  requires SpatialDim<Dim>
class DepthImage {
 public:
  /// `resolution` pixels along each edge of a face; all ranges start at `far` [m].
  DepthImage(int resolution, float far);

  [[nodiscard]] int resolution() const { return resolution_; }
  /// Pixel that holds `direction` (any length but 0).
  [[nodiscard]] std::size_t pixel(const Vec<Dim>& direction) const;
  /// Unit direction of a pixel's centre.
  [[nodiscard]] Vec<Dim> direction(std::size_t pixel) const { return place(pixel).normalized(); }
  /// The pixel's centre on the cube from -1 to 1.
  [[nodiscard]] Vec<Dim> place(std::size_t pixel) const;
  /// The directions from `pixel` to the end of its row.
  [[nodiscard]] PixelRun<Dim> run(std::size_t pixel) const;
  [[nodiscard]] std::size_t size() const { return ranges_.size(); }
  [[nodiscard]] std::span<const float> ranges() const { return ranges_; }
  [[nodiscard]] float& operator[](std::size_t pixel) { return ranges_[pixel]; }
  [[nodiscard]] float operator[](std::size_t pixel) const { return ranges_[pixel]; }
  /// Pixels [low, high) along each of the face's Dim - 1 axes.
  struct Rectangle {
    Eigen::Matrix<int, Dim - 1, 1> low, high;
    [[nodiscard]] bool empty() const { return (low.array() >= high.array()).any(); }
  };
  /// Pixels of `face` (0 .. 2 Dim - 1) whose directions can meet `box`, given relative to the viewpoint.
  [[nodiscard]] Rectangle rectangle(int face, const Box<Dim>& box) const;
  [[nodiscard]] std::size_t pixels_per_face() const { return ranges_.size() / (2 * Dim); }

 private:
  int resolution_;
  std::vector<float> ranges_;
};

/// Lowers the image by the scan's own ranges: least of the 2 x 2 rays (2D: 2) around each direction; 0 where any of them has no data or outside
/// the field of view.
template <int Dim>
void draw_ranges(DepthImage<Dim>& image, const Scan<Dim>& scan);

/// Lowers the image by the patches, seen from `origin`, each widened by `margin` plus half the cone's opening at its range [m, rad].
template <int Dim>
void draw_patches(DepthImage<Dim>& image, std::span<const Patch<Dim>> patches, const Vec<Dim>& origin, double margin, double cone_angle);

}  // namespace vantage
