// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/wkt.h"

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/io/geojson.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

/// From the opening bracket to the one that closes it; quotes hide brackets.
std::string_view bracketed(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (quoted) continue;
    depth += text[i] == '[';
    depth -= text[i] == ']';
    if (depth == 0) return text.substr(0, i);
  }
  return {};
}

}  // namespace

std::optional<int> wkt_epsg(std::string_view wkt) {
  const std::size_t projected = std::min(wkt.find("PROJCS["), wkt.find("PROJCRS["));
  if (projected == std::string_view::npos) return std::nullopt;
  const std::string_view system = bracketed(wkt.substr(wkt.find('[', projected)));
  const std::size_t last = std::max(system.rfind("AUTHORITY[") + 1, system.rfind("ID[") + 1);
  if (last == 0) return std::nullopt;
  std::string_view id = system.substr(last - 1);
  id.remove_prefix(id.find('[') + 1);
  id = id.substr(0, id.find(']'));
  if (take_word(id, "\", ") != "EPSG") return std::nullopt;
  const std::optional<int> code = to_number<int>(take_word(id, "\", "));
  // What follows must close the system: else the code is that of a part, its datum or its unit.
  const bool outermost = system.substr(last - 1).find(']') + 1 == system.size() - (last - 1);
  return outermost && code && *code > 0 && *code < kUserDefinedEpsg ? code : std::nullopt;
}

std::optional<int> crs_epsg(std::string_view text) {
  constexpr std::string_view kUrn = "urn:ogc:def:crs:EPSG:";
  std::string_view rest = text;
  std::string_view word = take_word(rest, " \t\r\n");
  if (!word.starts_with(kUrn) && !word.starts_with("EPSG:")) return wkt_epsg(text);
  if (word.starts_with(kUrn)) word.remove_prefix(word.rfind(':') + 1);
  try {
    return parse_epsg(word, {});
  } catch (const Error&) {
    return std::nullopt;  // Degrees, or no number.
  }
}

}  // namespace vantage
