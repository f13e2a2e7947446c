// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the readers of a map's picture, PNG and PGM.
#include "vantage/io/image.h"
#include "contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) {
    const vantage::GrayImage image = vantage::parse_gray_image(bytes, "fuzz.image", 205);
    demand(image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  });
}
