// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage {

namespace {

constexpr std::array<Rgb, 11> kViridis{{{68, 1, 84}, {72, 36, 117}, {65, 68, 135}, {53, 95, 141}, {42, 120, 142}, {33, 145, 140},
                                        {34, 168, 132}, {68, 191, 112}, {122, 209, 81}, {189, 223, 38}, {253, 231, 37}}};
constexpr std::array<Rgb, 11> kInferno{{{0, 0, 4}, {22, 11, 57}, {66, 10, 104}, {106, 23, 110}, {147, 38, 103}, {188, 55, 84},
                                        {221, 81, 58}, {243, 120, 25}, {252, 165, 10}, {246, 215, 70}, {252, 255, 164}}};

std::uint8_t channel(double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5); }

}  // namespace

Rgb mix(Rgb a, Rgb b, double t) {
  const auto blend = [t](std::uint8_t from, std::uint8_t to) { return channel((1.0 - t) * from + t * to); };
  return {blend(a.r, b.r), blend(a.g, b.g), blend(a.b, b.b)};
}

Rgb scaled(Rgb colour, double factor) { return {channel(colour.r * factor), channel(colour.g * factor), channel(colour.b * factor)}; }

std::string css(Rgb colour) { return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b); }

Rgb colour_of(ColourMap map, double t) {
  const auto& table = map == ColourMap::viridis ? kViridis : kInferno;
  const double place = (t > 0.0 ? std::min(t, 1.0) : 0.0) * static_cast<double>(table.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), table.size() - 2);
  return mix(table[i], table[i + 1], place - static_cast<double>(i));
}

std::string css_gradient(ColourMap map, double low, double high) {
  std::string stops;
  for (int i = 0; i <= 8; ++i) stops += "," + css(colour_of(map, low + (high - low) * i / 8.0));
  return "linear-gradient(90deg" + stops + ")";
}

void Image::set(int x, int y, Rgb colour, std::uint8_t alpha) {
  std::uint8_t* p = pixel(x, y);
  p[0] = colour.r;
  p[1] = colour.g;
  p[2] = colour.b;
  p[3] = alpha;
}

void lay_over(Image& base, const Image& top) {
  parallel_for(static_cast<std::size_t>(base.height), 16, [&](std::size_t row) {
    for (int x = 0; x < base.width; ++x) {
      std::uint8_t* below = base.pixel(x, static_cast<int>(row));
      const std::uint8_t* above = top.pixel(x, static_cast<int>(row));
      const double cover = above[3] / 255.0;
      const double rest = below[3] / 255.0 * (1.0 - cover);
      const double alpha = cover + rest;
      if (alpha <= 0.0) continue;
      for (int c = 0; c < 3; ++c) below[c] = channel((above[c] * cover + below[c] * rest) / alpha);
      below[3] = channel(alpha * 255.0);
    }
  });
}

}  // namespace vantage
