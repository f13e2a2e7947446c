// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/json_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "vantage/base/error.h"
#include "vantage/io/text.h"

namespace vantage {
namespace {

constexpr double kBytesPerByte = 32.0;  ///< Of memory for one of text, at most, as measured on numbers of few digits.

/// Offset of the bracket that nests too deep; that of the end if none does.
std::size_t too_deep(std::string_view bytes, int most) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char c = bytes[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    depth += (c == '[' || c == '{') - (c == ']' || c == '}');
    if (depth > most) return i;
  }
  return bytes.size();
}

}  // namespace

template <class Json>
Json parse_json(std::string_view bytes, std::string_view where, std::size_t begin) {
  constexpr int kDeepest = 100;
  const auto fail = [&](std::size_t at, const std::string& message) {
    throw Error(ErrorCode::bad_input, message, fmt::format("{}:{}", where, begin + at));
  };
  require_memory(static_cast<double>(bytes.size()), kBytesPerByte, where);
  if (const std::size_t at = too_deep(bytes, kDeepest); at < bytes.size()) fail(at, fmt::format("JSON nests deeper than {}", kDeepest));
  try {
    return Json::parse(bytes);
  } catch (const typename Json::parse_error& error) {
    const std::string what = error.what();  // Begins with the library's name of the error and the place.
    const std::size_t reason = what.find("syntax error");
    fail(error.byte > 0 ? error.byte - 1 : 0, "not JSON: " + printable(reason == std::string::npos ? what : what.substr(reason), 120));
  } catch (const typename Json::exception& error) {  // A number too large for a double.
    fail(0, "not JSON: " + printable(error.what(), 120));
  }
  return {};
}

template nlohmann::json parse_json(std::string_view, std::string_view, std::size_t);
template nlohmann::ordered_json parse_json(std::string_view, std::string_view, std::size_t);

}  // namespace vantage
