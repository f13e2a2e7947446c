// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "vantage/report/camera.h"
#include "vantage/report/image.h"

namespace vantage {

/// Software rasteriser with a depth buffer of 2 x 2 samples a pixel. A sample keeps the nearest surface (of equally near ones the darker colour value),
/// so that the picture does not depend on the order of the calls: all drawing may happen on many threads at once.
class Raster {
 public:
  static constexpr int kSamples = 2;  ///< Along each side of a pixel.
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

  explicit Raster(const Camera& camera);

  /// A disc of `radius` pixels that faces the eye.
  void point(const Vec<3>& p, double radius, Rgb colour);
  /// A line `width` pixels wide.
  void segment(const Vec<3>& a, const Vec<3>& b, double width, Rgb colour);
  /// A convex polygon; one too small to meet a sample still marks the nearest.
  void polygon(std::span<const Vec<3>> corners, Rgb colour);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] int width() const { return width_; }    ///< [samples]
  [[nodiscard]] int height() const { return height_; }  ///< [samples]
  [[nodiscard]] bool empty(int x, int y) const { return at(x, y) == kEmpty; }
  [[nodiscard]] float distance(int x, int y) const;  ///< [m]
  [[nodiscard]] Rgb colour(int x, int y) const;

 private:
  [[nodiscard]] const std::uint64_t& at(int x, int y) const { return cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]; }
  [[nodiscard]] Projected sample(const Vec<3>& p) const;
  void put(int x, int y, double depth, Rgb colour);
  void triangle(const Projected& a, const Projected& b, const Projected& c, Rgb colour);

  Camera camera_;
  int width_, height_;
  std::vector<std::uint64_t> cells_;  ///< Distance as float bits, then the colour.
};

/// Soft light by the depth around each sample: hollows and what lies behind an edge are darker (after eye-dome lighting, but even on slopes).
struct Shading {
  double strength = 1.0;  ///< 0: flat colours.
};

/// The shaded picture, edges smoothed, transparent where nothing was drawn.
[[nodiscard]] Image resolved(const Raster& raster, const Shading& shading = {});

}  // namespace vantage
