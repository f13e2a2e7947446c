// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vantage {

namespace {

constexpr std::string_view kThinSpace = "\u202f";

/// Thin spaces between the thousands of the whole part.
std::string grouped(const std::string& digits) {
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  const std::size_t sign = digits.starts_with('-') ? 1 : 0;
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > sign && i < whole && (whole - i) % 3 == 0 && whole - sign > 4) text += kThinSpace;
    text += digits[i];
  }
  return text;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      case '\'': safe += "&#39;"; break;
      default: safe += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return safe;
}

std::string number(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  const double size = std::abs(value);
  if (size == 0.0) return "0";
  if (size < 1e-4 || size >= 1e12) return fmt::format("{:.2e}", value);
  int decimals = 0;
  for (double limit = 100.0; size < limit && decimals < 6; limit /= 10.0) ++decimals;
  return grouped(fmt::format("{:.{}f}", value, decimals));
}

std::string rounded(double value) {
  const double size = std::abs(value);
  return size != 0.0 && (size < 1e-4 || size >= 1e12) ? fmt::format("{:g}", value) : grouped(fmt::format("{:.12g}", value));
}

std::string number(std::int64_t value) { return grouped(fmt::format("{}", value)); }

std::string quantity(double value, std::string_view unit) { return number(value) + "\u00a0" + std::string(unit); }

std::string percent(double share, bool up) {
  if (!std::isfinite(share)) return "–";
  const double clamped = std::clamp(share, 0.0, 1.0);
  const int decimals = clamped >= 0.99 && clamped < 1.0 ? 2 : 1;
  const double unit = decimals == 2 ? 100.0 : 10.0;
  const double scaled = clamped * 100.0 * unit;
  // A hair of slack keeps 0.997 from becoming 99.69 %.
  const double rounded = up ? std::ceil(scaled - 1e-7) : std::floor(scaled + 1e-7);
  const double shown = (clamped < 1.0 && !up) ? std::min(rounded, 100.0 * unit - 1.0) : rounded;
  if (clamped == 1.0) return "100\u00a0%";
  return fmt::format("{:.{}f}\u00a0%", shown / unit, decimals);
}

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
  return number(count) + "\u00a0" + std::string(count == 1 ? one : many);
}

}  // namespace vantage
