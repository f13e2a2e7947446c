// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/report/raster.h"

namespace vantage {

namespace {

/// Distances at which the surroundings are asked [samples].
constexpr std::array<int, 4> kRadii{1, 3, 7, 16};
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

/// How far the neighbour at one side stands before the sample, in steps of the screen distance; behind counts too, but less than a step.
double before(float own, float other, double step) { return other > 0.0F ? std::clamp((own - other) / step, -1.0, 1.0) : 0.0; }

/// Share of the light kept away [0, 1]: a second difference, so that an even slope is not darkened.
double obscured(const Depths& depths, int x, int y, double sample_size) {
  const float own = depths.at(x, y);
  double sum = 0.0;
  for (const int radius : kRadii) {
    for (const auto& axis : kAxes) {
      const int dx = axis[0] * radius, dy = axis[1] * radius;
      const double step = 3.0 * sample_size * radius;
      const double hollow = before(own, depths.at(x + dx, y + dy), step) + before(own, depths.at(x - dx, y - dy), step);
      sum += std::max(hollow, 0.0);
    }
  }
  return sum / (2.0 * kRadii.size() * kAxes.size());
}

}  // namespace

Image resolved(const Raster& raster, const Shading& shading) {
  const Depths depths(raster);
  const Camera& camera = raster.camera();
  Image image(camera.width(), camera.height());
  parallel_for(static_cast<std::size_t>(image.height), 4, [&](std::size_t row) {
    for (int x = 0; x < image.width; ++x) {
      std::array<double, 3> sum{};
      int count = 0;
      for (int k = 0; k < Raster::kSamples * Raster::kSamples; ++k) {
        const int sx = x * Raster::kSamples + k % Raster::kSamples, sy = static_cast<int>(row) * Raster::kSamples + k / Raster::kSamples;
        if (raster.empty(sx, sy)) continue;
        const double sample_size = camera.pixel_size(raster.distance(sx, sy)) / Raster::kSamples;
        const double light = shading.strength > 0.0 ? 1.0 / (1.0 + shading.strength * 3.0 * obscured(depths, sx, sy, sample_size)) : 1.0;
        const Rgb colour = raster.colour(sx, sy);
        sum = {sum[0] + light * colour.r, sum[1] + light * colour.g, sum[2] + light * colour.b};
        ++count;
      }
      if (count == 0) continue;
      const auto mean = [count](double s) { return static_cast<std::uint8_t>(s / count + 0.5); };
      image.set(x, static_cast<int>(row), {mean(sum[0]), mean(sum[1]), mean(sum[2])},
                static_cast<std::uint8_t>(count * 255 / (Raster::kSamples * Raster::kSamples)));
    }
  });
  return image;
}

}  // namespace vantage
