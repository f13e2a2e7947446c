// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of lists of poses.
#include "vantage/session/poses.h"
#include "contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view text) {
    for (const vantage::FilePose& pose : vantage::parse_poses(text, "poses.csv")) {
      demand(pose.position.allFinite());
      demand(!pose.orientation || std::abs(pose.orientation->norm() - 1.0) < 1e-9);
    }
  });
}
