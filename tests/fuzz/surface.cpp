// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of surfaces.
#include "contract.h"
#include "vantage/io/patch_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) {
    std::visit(
        [](const auto& patches) {
          for (const auto& patch : patches)
            for (const auto& corner : patch.corners()) demand(corner.allFinite());
        },
        vantage::parse_patches(bytes, "fuzz.ply"));
  });
}
