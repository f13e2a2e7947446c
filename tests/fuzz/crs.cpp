// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of coordinate systems in well-known text, as scans carry it.
#include "contract.h"
#include "vantage/io/wkt.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view text) { demand(vantage::crs_epsg(text).value_or(1) > 0); });
}
