// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace vantage {

/// Value of SHA-256; compares like its bytes.
using Digest = std::array<std::uint8_t, 32>;

/// SHA-256 (FIPS 180-4) of `bytes`: two different deltas never share one by accident, or on purpose.
[[nodiscard]] Digest sha256(std::string_view bytes);

/// Lower-case hexadecimal digits, as `sha256sum` prints them; the first `digits` of 64.
[[nodiscard]] std::string as_hex(const Digest& digest, std::size_t digits = 64);

}  // namespace vantage
