// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the header of NumPy files.
#include "vantage/io/npy.h"
#include "contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) { demand(!vantage::describe_npy(bytes, "fuzz.npy").empty()); });
}
