// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <charconv>
#include <optional>
#include <string_view>

namespace vantage {

/// Steps through a text line by line and word by word, counting lines from 1.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text, std::size_t line = 0) : rest_(text), line_(line) {}

  /// The next line without its end (LF or CR LF); nullopt at the end of the text.
  std::optional<std::string_view> next_line() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++line_;
    return line;
  }
  [[nodiscard]] std::size_t line() const { return line_; }  ///< Number of the line given last.
  [[nodiscard]] std::size_t remaining() const { return rest_.size(); }

 private:
  std::string_view rest_;
  std::size_t line_;
};

/// Takes the next word off `line`; empty at the end. `separators` stand between words.
[[nodiscard]] inline std::string_view take_word(std::string_view& line, std::string_view separators = " \t\r") {
  const std::size_t begin = line.find_first_not_of(separators);
  if (begin == std::string_view::npos) {
    line = {};
    return {};
  }
  const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// The whole word as a number (also `nan`, `inf`, a leading `+`), else nullopt.
template <class Number>
[[nodiscard]] std::optional<Number> to_number(std::string_view word) {
  if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace vantage
