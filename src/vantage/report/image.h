// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vantage {

/// A colour of the screen, 8 bits a channel.
struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  [[nodiscard]] bool operator==(const Rgb&) const = default;
};

/// (1 - t) a + t b, t in [0, 1].
[[nodiscard]] Rgb mix(Rgb a, Rgb b, double t);
/// Brightness times `factor`, clamped to white.
[[nodiscard]] Rgb scaled(Rgb colour, double factor);
/// `#rrggbb`.
[[nodiscard]] std::string css(Rgb colour);

/// Perceptually uniform colour maps (van der Walt and Smith), from tables.
enum class ColourMap { viridis, inferno };
/// Colour at t in [0, 1], clamped.
[[nodiscard]] Rgb colour_of(ColourMap map, double t);
/// The part [low, high] of a map as a CSS `linear-gradient` from left to right.
[[nodiscard]] std::string css_gradient(ColourMap map, double low, double high);

/// Pixels with straight alpha, 4 bytes each (red, green, blue, alpha), top row first; all transparent at first.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  Image() = default;
  Image(int w, int h) : width(w), height(h), rgba(std::size_t{4} * static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0) {}
  [[nodiscard]] std::uint8_t* pixel(int x, int y) { return &rgba[std::size_t{4} * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))]; }
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const { return const_cast<Image*>(this)->pixel(x, y); }
  void set(int x, int y, Rgb colour, std::uint8_t alpha = 255);
};

/// Lays `top` over `base`; both have the same size.
void lay_over(Image& base, const Image& top);

}  // namespace vantage
