// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "vantage/base/parallel.h"
#include "vantage/report/raster.h"

namespace vantage {

namespace {

/// Distances at which the surroundings are asked [samples]: close ones of every sample, which draws edges, wide ones once a pixel.
constexpr std::array<int, 2> kClose{1, 3};
constexpr std::array<int, 5> kWide{5, 8, 12, 17, 24};
constexpr std::array<std::array<int, 2>, 4> kAxes{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};

/// Distances of all samples, 0 where empty, so that the shading reads plain floats.
struct Depths {
  int width, height;
  std::vector<float> values;

  explicit Depths(const Raster& raster)
      : width(raster.width()), height(raster.height()), values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F) {
    parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < width; ++x) {
        if (!raster.empty(x, y)) values[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = raster.distance(x, y);
      }
    });
  }
  [[nodiscard]] float at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return 0.0F;
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// How far a neighbour stands before the sample, in steps of the screen distance; what stands behind counts as open. Close by, an edge is drawn
/// against all that lies behind it; farther off, what stands far before the sample is something else and casts little shade.
double before(float own, float other, double step, bool close) {
  const double gap = (own - other) / step;
  if (gap > 1.0) return close ? 1.0 : 1.0 / (gap * gap);
  return std::max(gap, -1.0);
}

/// Share of the light kept away [0, 1] by what stands at `radii`: second differences, so that an even slope is not darkened.
double obscured(const Depths& depths, int x, int y, double sample_size, std::span<const int> radii) {
  const bool close = radii.data() == kClose.data();
  const float own = depths.at(x, y);
  double sum = 0.0;
  for (const int radius : radii) {
    const double step = 3.0 * sample_size * radius;
    for (const auto& axis : kAxes) {
      const float one = depths.at(x + axis[0] * radius, y + axis[1] * radius), other = depths.at(x - axis[0] * radius, y - axis[1] * radius);
      if (one > 0.0F && other > 0.0F) sum += std::max(before(own, one, step, close) + before(own, other, step, close), 0.0);
    }
  }
  return sum / (2.0 * static_cast<double>(radii.size() * kAxes.size()));
}

/// Colour and cover of one pixel from its samples.
struct Pixel {
  std::array<double, 3> sum{};
  int count = 0;
};

Pixel shaded(const Raster& raster, const Depths& depths, int x, int y, double strength) {
  Pixel pixel;
  double wide = -1.0;
  for (int k = 0; k < Raster::kSamples * Raster::kSamples; ++k) {
    const int sx = x * Raster::kSamples + k % Raster::kSamples, sy = y * Raster::kSamples + k / Raster::kSamples;
    if (raster.empty(sx, sy)) continue;
    double light = 1.0;
    if (strength > 0.0) {
      const double size = raster.camera().pixel_size(raster.distance(sx, sy)) / Raster::kSamples;
      if (wide < 0.0) wide = obscured(depths, sx, sy, size, kWide);
      light = 1.0 / (1.0 + strength * (1.3 * obscured(depths, sx, sy, size, kClose) + 2.4 * wide));
    }
    const Rgb colour = raster.colour(sx, sy);
    pixel.sum = {pixel.sum[0] + light * colour.r, pixel.sum[1] + light * colour.g, pixel.sum[2] + light * colour.b};
    ++pixel.count;
  }
  return pixel;
}

}  // namespace

Image resolved(const Raster& raster, const Shading& shading) {
  const Depths depths(raster);
  Image image(raster.camera().width(), raster.camera().height());
  parallel_for(static_cast<std::size_t>(image.height), 4, [&](std::size_t row) {
    for (int x = 0; x < image.width; ++x) {
      const auto [sum, count] = shaded(raster, depths, x, static_cast<int>(row), shading.strength);
      if (count == 0) continue;
      const auto mean = [n = count](double s) { return static_cast<std::uint8_t>(s / n + 0.5); };
      image.set(x, static_cast<int>(row), {mean(sum[0]), mean(sum[1]), mean(sum[2])},
                static_cast<std::uint8_t>(count * 255 / (Raster::kSamples * Raster::kSamples)));
    }
  });
  return image;
}

}  // namespace vantage
