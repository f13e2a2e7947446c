// SPDX-License-Identifier: Apache-2.0
// libFuzzer on a reader of zones: what it gives bounds an area.
#include "contract.h"
#include "vantage/session/zone_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view text) {
    const std::vector<vantage::Zone> zones = vantage::VANTAGE_FUZZ_ZONES(text, "fuzz");
    demand(!zones.empty());
    for (const vantage::Zone& zone : zones)
      for (const auto& ring : zone.rings) {
        demand(ring.size() >= 3);
        for (const vantage::Vec<2>& corner : ring) demand(corner.allFinite());
      }
  });
}
