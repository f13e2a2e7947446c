// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// Cuts the first line off `text`, without its end (`\n`, `\r\n` or `\r`).
[[nodiscard]] std::string_view next_line(std::string_view& text);

/// Cuts the first word off `text`, skipping blanks (and line ends); empty when none is left.
[[nodiscard]] std::string_view next_word(std::string_view& text);

/// The number that `word` begins with, a leading `+` and "2." allowed; infinity if it is too large for a double. nullopt: it begins with none.
[[nodiscard]] std::optional<double> leading_number(std::string_view word);

/// The same for a whole number; nullopt also when it is too large.
[[nodiscard]] std::optional<std::int64_t> leading_integer(std::string_view word);

/// Fit for an error message: at most `most` bytes, everything but printable ASCII replaced by `?`.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = 40);

}  // namespace vantage
