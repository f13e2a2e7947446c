// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

/// `1,234,567`
[[nodiscard]] std::string grouped(std::int64_t value);
/// `8 s`, `2:05`, `1:02:45`
[[nodiscard]] std::string duration(double seconds);
/// `12.3 M`, `842 k`, `912`
[[nodiscard]] std::string rounded(double value);
