// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Shades, 0 black to 255 white; row 0 is the top.
struct GrayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< (height, width)
};

/// PNG (any colour type, by luminance; transparent parts show `background`) or PGM (P2, P5; any depth, scaled to 255), told by content, at most
/// 64 million pixels. Throws io; bad_input, naming the file, for anything else or a file cut short. No size is believed before its bytes are there.
[[nodiscard]] GrayImage read_gray_image(const std::filesystem::path& path, std::uint8_t background);
/// The same from memory.
[[nodiscard]] GrayImage parse_gray_image(std::string_view bytes, const std::string& name, std::uint8_t background);

}  // namespace vantage
