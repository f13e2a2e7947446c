// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "vantage/base/error.h"

namespace vantage {
namespace {

constexpr double kDegreesPerRadian = 57.295779513082320877;

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};

template <class Number>
Number parse_number(std::string_view text, const Option& option, std::string_view full_name) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc() && end == text.data() + text.size(), fmt::format("{} = {}: must be {}", full_name, text, option.allowed()));
  return value;
}

}  // namespace

std::string Option::text() const {
  return std::visit(Overloaded{[](const double* v) { return fmt::format("{}", *v); }, [](const std::int64_t* v) { return fmt::format("{}", *v); },
                               [](const bool* v) { return std::string(*v ? "true" : "false"); },
                               [](const Angle& a) { return fmt::format("{:.10g}", *a.radians * kDegreesPerRadian); },
                               [](const Choice& c) { return c.names.at(static_cast<std::size_t>(c.get())); }},
                    value);
}

std::string Option::allowed() const {
  if (const auto* choice = std::get_if<Choice>(&value)) return fmt::format("{}", fmt::join(choice->names, " | "));
  if (std::holds_alternative<bool*>(value)) return "true | false";
  const std::string suffix = unit.empty() ? "" : " [" + unit + "]";
  const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
  if (low && high) return fmt::format("{} .. {}{}", range.low, range.high, suffix);
  if (low) return fmt::format(">= {}{}", range.low, suffix);
  if (high) return fmt::format("<= {}{}", range.high, suffix);
  return "a number" + suffix;
}

void Option::parse(std::string_view text, std::string_view full_name) {
  std::visit(Overloaded{[&](double* v) { *v = parse_number<double>(text, *this, full_name); },
                        [&](std::int64_t* v) { *v = parse_number<std::int64_t>(text, *this, full_name); },
                        [&](Angle& a) { *a.radians = parse_number<double>(text, *this, full_name) / kDegreesPerRadian; },
                        [&](bool* v) {
                          require(text == "true" || text == "false", fmt::format("{} = {}: must be true | false", full_name, text));
                          *v = text == "true";
                        },
                        [&](Choice& c) {
                          for (std::size_t i = 0; i < c.names.size(); ++i)
                            if (c.names[i] == text) return c.set(static_cast<int>(i));
                          require(false, fmt::format("{} = {}: must be {}", full_name, text, allowed()));
                        }},
             value);
  check(full_name);
}

void Option::check(std::string_view full_name) const {
  const auto inside = [&](double v) { return v >= range.low && v <= range.high; };  // False for NaN.
  const bool good = std::visit(Overloaded{[&](double* v) { return inside(*v); }, [&](std::int64_t* v) { return inside(static_cast<double>(*v)); },
                                          [&](const Angle& a) {  // The conversion may round an end of the range by a few bits.
                                            const double degrees = *a.radians * kDegreesPerRadian;
                                            return degrees >= range.low * (1.0 - 1e-12) && degrees <= range.high * (1.0 + 1e-12);
                                          },
                                          // Spelt out: a generic lambda would match `double*` better than `const double*` does.
                                          [](const bool*) { return true; }, [](const Choice&) { return true; }},
                               value);
  require(good, fmt::format("{} = {}: must be {}", full_name, text(), allowed()));
}

}  // namespace vantage
