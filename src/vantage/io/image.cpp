// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/image.h"

#include <fmt/format.h>
#include <png.h>

#include <string>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

constexpr std::int64_t kMostPixels = 64'000'000;
constexpr std::int64_t kBestDeflate = 1040;  ///< No deflate stream grows by more.

[[noreturn]] void fail(const std::string& message, const std::string& name) { throw Error(ErrorCode::bad_input, message, name); }

/// Pixels in all; throws for none, or too many.
std::size_t count_pixels(std::int64_t width, std::int64_t height, const std::string& name) {
  const bool good = width > 0 && height > 0 && width <= kMostPixels && height <= kMostPixels && width * height <= kMostPixels;
  require(good, fmt::format("image of {} x {} pixels: must be 1 .. 64 million in all", width, height), name);
  return static_cast<std::size_t>(width * height);
}

/// Releases what libpng holds.
struct PngImage {
  png_image image{};
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(&image); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

GrayImage parse_png(std::string_view bytes, std::uint8_t background, const std::string& name) {
  PngImage png;
  if (!png_image_begin_read_from_memory(&png.image, bytes.data(), bytes.size())) fail(fmt::format("PNG: {}", printable(png.image.message)), name);
  GrayImage gray{static_cast<int>(png.image.width), static_cast<int>(png.image.height), {}};
  const std::size_t count = count_pixels(png.image.width, png.image.height, name);
  if (count / 8 > static_cast<std::size_t>(kBestDeflate) * bytes.size())
    fail(fmt::format("image of {} x {} pixels exceeds the file", gray.width, gray.height), name);
  png.image.format = PNG_FORMAT_GRAY;
  png.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // Shades as written, whatever the depth.
  gray.pixels.resize(count);
  const png_color behind{background, background, background};
  if (!png_image_finish_read(&png.image, &behind, gray.pixels.data(), 0, nullptr)) fail(fmt::format("PNG: {}", printable(png.image.message)), name);
  return gray;
}

/// The next number of a PGM header, past blanks and comments.
std::int64_t header_number(std::string_view& text, const std::string& name) {
  for (;;) {
    const std::size_t start = std::min(text.find_first_not_of(" \t\r\n\v\f"), text.size());
    text.remove_prefix(start);
    if (!text.starts_with('#')) break;
    (void)next_line(text);
  }
  const auto value = leading_integer(next_word(text));
  require(value && *value > 0, "PGM header: needs width, height and greatest shade", name);
  return *value;
}

GrayImage parse_pgm(std::string_view text, const std::string& name) {
  const bool ascii = text[1] == '2';
  text.remove_prefix(2);
  const std::int64_t width = header_number(text, name), height = header_number(text, name), most = header_number(text, name);
  require(most <= 65535, fmt::format("PGM header: greatest shade {}: must be 1 .. 65535", most), name);
  const std::size_t count = count_pixels(width, height, name), each = ascii ? 2 : most > 255 ? 2 : 1;
  text.remove_prefix(std::min<std::size_t>(1, text.size()));  // One blank.
  require(text.size() + (ascii ? 1 : 0) >= count * each, fmt::format("PGM: {} x {} pixels exceed the file", width, height), name);
  GrayImage gray{static_cast<int>(width), static_cast<int>(height), std::vector<std::uint8_t>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t value = 0;
    if (ascii)
      value = leading_integer(next_word(text)).value_or(-1);
    else
      for (std::size_t k = 0; k < each; ++k) value = value << 8 | static_cast<unsigned char>(text[i * each + k]);
    if (value < 0 || value > most) fail(fmt::format("PGM: pixel {}: must be 0 .. {}", i, most), name);
    gray.pixels[i] = static_cast<std::uint8_t>((value * 255 + most / 2) / most);
  }
  return gray;
}

}  // namespace

GrayImage read_gray_image(const std::filesystem::path& path, std::uint8_t background) {
  return parse_gray_image(read_file(path), path.string(), background);
}

GrayImage parse_gray_image(std::string_view bytes, const std::string& name, std::uint8_t background) {
  require(!bytes.empty(), "is empty", name);
  if (bytes.starts_with("\x89PNG")) return parse_png(bytes, background, name);
  if (bytes.starts_with("P2") || bytes.starts_with("P5")) return parse_pgm(bytes, name);
  fail("not an image: must be PNG or PGM (P2, P5)", name);
}

}  // namespace vantage
