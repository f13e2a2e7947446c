// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

/// `1,234,567`
[[nodiscard]] std::string grouped(std::int64_t value);
/// `8.2 s`, `48 s`, `2:05`, `1:02:45`
[[nodiscard]] std::string duration(double seconds);
/// The same in whole seconds, for a display that runs: `8 s`
[[nodiscard]] std::string stopwatch(double seconds);
/// `12.3 M`, `842 k`, `912`
[[nodiscard]] std::string rounded(double value);
