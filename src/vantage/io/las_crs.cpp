// SPDX-License-Identifier: Apache-2.0
// The coordinate system among the variable length records of a LAS file. Damage there costs the system, not the points.
#include <algorithm>

#include "vantage/io/scan_formats.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

constexpr std::size_t kRecordHeader = 54;
constexpr std::uint16_t kGeoKeys = 34735, kWkt = 2112, kProjectedKey = 3072, kUserDefined = 32767;

/// Four numbers a key: what it is, where its value stands (0: here), how many, the value. The first four are no key.
std::optional<int> code_of_keys(std::string_view keys) {
  for (std::size_t at = 8; at + 8 <= keys.size(); at += 8) {
    if (get<std::uint16_t>(keys, at) != kProjectedKey || get<std::uint16_t>(keys, at + 2) != 0) continue;
    const auto code = get<std::uint16_t>(keys, at + 6);
    if (code > 0 && code < kUserDefined) return code;
  }
  return std::nullopt;
}

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

/// The code that stands last in the projected system: AUTHORITY["EPSG","25832"] or ID["EPSG",25832].
std::optional<int> code_of_wkt(std::string_view wkt) {
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
  return outermost && code && *code > 0 && *code < kUserDefined ? code : std::nullopt;
}

}  // namespace

std::optional<int> las_epsg(FileBytes file) {
  if (file.size() < 227) return std::nullopt;
  const std::string_view bytes = file.all();
  const auto points_begin = std::min<std::size_t>(get<std::uint32_t>(bytes, 96), bytes.size());
  const auto records = get<std::uint32_t>(bytes, 100);
  std::size_t at = get<std::uint16_t>(bytes, 94);
  for (std::uint32_t k = 0; k < records && at + kRecordHeader <= points_begin; ++k) {
    const auto id = get<std::uint16_t>(bytes, at + 18);
    const std::size_t length = get<std::uint16_t>(bytes, at + 20);
    const bool projection = bytes.substr(at + 2, 15) == "LASF_Projection";
    at += kRecordHeader;
    if (length > points_begin - at) return std::nullopt;
    const std::string_view data = bytes.substr(at, length);
    if (projection && (id == kGeoKeys || id == kWkt))
      if (const std::optional<int> code = id == kGeoKeys ? code_of_keys(data) : code_of_wkt(data)) return code;
    at += length;
  }
  return std::nullopt;
}

}  // namespace vantage
