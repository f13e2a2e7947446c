// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "vantage/field/field.h"

namespace vantage::bench {

/// What another program makes of the same ball.
struct PeerDistance {
  std::string name;
  double cpu = 0.0;    ///< [s]
  double error = 0.0;  ///< Largest, against the closed form, within the band that it promises [steps].
};

/// Signed distance of the whole lattice from a ball's nodes by OpenVDB's fogToSdf.
[[nodiscard]] PeerDistance openvdb_fog_to_sdf(const Field<3, std::uint8_t>& inside, double radius);

/// CPU time of this process and its threads so far [s].
[[nodiscard]] double cpu_seconds();

}  // namespace vantage::bench
