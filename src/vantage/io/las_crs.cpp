// SPDX-License-Identifier: Apache-2.0
// The coordinate system among the variable length records of a LAS file. Damage there costs the system, not the points.
#include <algorithm>

#include "vantage/io/scan_formats.h"
#include "vantage/io/wkt.h"

namespace vantage {
namespace {

constexpr std::size_t kRecordHeader = 54;
constexpr std::uint16_t kGeoKeys = 34735, kWkt = 2112, kProjectedKey = 3072;

/// Four numbers a key: what it is, where its value stands (0: here), how many, the value. The first four are no key.
std::optional<int> code_of_keys(std::string_view keys) {
  for (std::size_t at = 8; at + 8 <= keys.size(); at += 8) {
    if (get<std::uint16_t>(keys, at) != kProjectedKey || get<std::uint16_t>(keys, at + 2) != 0) continue;
    const auto code = get<std::uint16_t>(keys, at + 6);
    if (code > 0 && code < kUserDefinedEpsg) return code;
  }
  return std::nullopt;
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
      if (const std::optional<int> code = id == kGeoKeys ? code_of_keys(data) : wkt_epsg(data)) return code;
    at += length;
  }
  return std::nullopt;
}

}  // namespace vantage
