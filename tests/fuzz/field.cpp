// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of fields.
#include "contract.h"
#include "vantage/io/vti.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) {
    const vantage::LatticeImage image = vantage::parse_vti(bytes, "fuzz.vti");
    for (const vantage::LatticeArray& array : image.arrays)
      demand(std::visit([](const auto& values) { return values.size(); }, array.values) == image.window.size());
  });
}
