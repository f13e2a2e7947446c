// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of the .yaml beside a map's picture.
#include "contract.h"
#include "vantage/io/occupancy_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view text) {
    const vantage::MapDescription map = vantage::parse_map_description(std::string(text), "fuzz.yaml");
    demand(!map.image.empty() && map.resolution > 0.0 && map.origin.allFinite() && std::isfinite(map.yaw));
    demand(map.free_threshold >= 0.0 && map.free_threshold <= map.occupied_threshold && map.occupied_threshold <= 1.0);
  });
}
