// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of scenario files.
#include "contract.h"
#include "vantage/session/scenario_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view text) {
    for (const vantage::Setting& setting : vantage::parse_scenario(text, "none/fuzz.toml")) demand(setting.name.find('.') != std::string::npos);
  });
}
