// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/png.h"

#include <png.h>

#include <memory>

#include "vantage/base/error.h"

namespace vantage {

namespace {

[[noreturn]] void fail(png_structp, png_const_charp message) { throw Error(ErrorCode::io, std::string("report: PNG: ") + message); }
void ignore(png_structp, png_const_charp) {}
void append(png_structp writer, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<const char*>(bytes), count);
}
void flush(png_structp) {}

/// libpng's pair of structures.
struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
  png_infop info = png_create_info_struct(png);
  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

void write_palette(Writer& writer, const std::vector<std::uint32_t>& palette) {
  std::vector<png_color> colours;
  std::vector<png_byte> alphas;
  for (const std::uint32_t c : palette) {
    colours.push_back({static_cast<png_byte>(c), static_cast<png_byte>(c >> 8), static_cast<png_byte>(c >> 16)});
    alphas.push_back(static_cast<png_byte>(c >> 24));
  }
  png_set_PLTE(writer.png, writer.info, colours.data(), static_cast<int>(colours.size()));
  png_set_tRNS(writer.png, writer.info, alphas.data(), static_cast<int>(alphas.size()), nullptr);
}

}  // namespace

std::string png(const Image& image) {
  const IndexedImage indexed = quantised(image);
  std::string file;
  Writer writer;
  png_set_write_fn(writer.png, &file, append, flush);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(indexed.width), static_cast<png_uint_32>(indexed.height), 8, PNG_COLOR_TYPE_PALETTE,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(writer.png, 8);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  write_palette(writer, indexed.palette);
  png_write_info(writer.png, writer.info);
  for (int y = 0; y < indexed.height; ++y) {
    png_write_row(writer.png, &indexed.indices[static_cast<std::size_t>(y) * static_cast<std::size_t>(indexed.width)]);
  }
  png_write_end(writer.png, writer.info);
  return file;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const auto byte = [&](std::size_t k) { return k < left ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) : 0U; };
    const std::uint32_t word = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? digits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

}  // namespace vantage
