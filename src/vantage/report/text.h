// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace vantage {

/// Text safe inside elements and quoted attributes of HTML; control characters become spaces.
[[nodiscard]] std::string escaped(std::string_view text);

/// The number with about three significant digits and thin spaces between thousands: `1 234`, `12.3`, `0.0981`.
[[nodiscard]] std::string number(double value);
[[nodiscard]] std::string number(std::int64_t value);
/// A round number without needless zeros: `20`, `0.5`.
[[nodiscard]] std::string rounded(double value);
/// A number and its unit, kept on one line; an infinite value is the sign, one that is not a number a dash.
[[nodiscard]] std::string quantity(double value, std::string_view unit);
/// A share in percent, rounded down (100 % is said of 1 alone), or up for an upper bound.
[[nodiscard]] std::string percent(double share, bool up = false);
/// `1 scan`, `3 scans`.
[[nodiscard]] std::string counted(std::int64_t count, std::string_view one, std::string_view many);

/// Unit of the seen volume: an area in 2D.
template <int Dim>
[[nodiscard]] constexpr std::string_view volume_unit() {
  constexpr std::string_view units[] = {"m²", "m³"};
  return units[Dim - 2];
}
template <int Dim>
[[nodiscard]] constexpr std::string_view volume_word() {
  constexpr std::string_view words[] = {"area", "volume"};
  return words[Dim - 2];
}

}  // namespace vantage
