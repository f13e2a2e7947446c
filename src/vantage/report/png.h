// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vantage/report/image.h"

namespace vantage {

/// At most 256 colours with alpha and which of them each pixel has.
struct IndexedImage {
  int width = 0, height = 0;
  std::vector<std::uint32_t> palette;  ///< red | green << 8 | blue << 16 | alpha << 24
  std::vector<std::uint8_t> indices;   ///< (height, width)
};

/// The image in at most 256 colours: its own if they are so few, else by median cut over 5 bits a colour channel and 3 bits of alpha.
[[nodiscard]] IndexedImage quantised(const Image& image);

/// The image as a palette PNG file in memory.
[[nodiscard]] std::string png(const Image& image);

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace vantage
