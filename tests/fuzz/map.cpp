// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of exchanged maps, down to their patches.
#include "contract.h"
#include "vantage/exchange/exchange_map.h"
#include "vantage/exchange/sealed_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) {
    const vantage::ExchangeMap map = vantage::parse_map(bytes, "fuzz.map");
    demand(map.bytes() == bytes);
    if (map.dim() == 2) (void)vantage::map_patches<2>(map, "fuzz.map");
    if (map.dim() == 3) (void)vantage::map_patches<3>(map, "fuzz.map");
  });
}

/// Three in four changes get checksums that hide them.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 4 == 0) return size;
  const std::string file = vantage::samples::resealed_map({reinterpret_cast<const char*>(data), size});
  std::copy(file.begin(), file.end(), data);
  return file.size();
}
