// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of fields: whatever the bytes are, they load or vantage::Error is thrown.
#include <cstdlib>

#include "vantage/base/error.h"
#include "vantage/io/vti.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const vantage::LatticeImage image = vantage::parse_vti({reinterpret_cast<const char*>(data), size}, "fuzz.vti");
    for (const vantage::LatticeArray& array : image.arrays)
      if (std::visit([](const auto& values) { return values.size(); }, array.values) != image.window.size()) std::abort();
  } catch (const vantage::Error& error) {
    if (error.code() != vantage::ErrorCode::bad_input || std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
