// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "vantage/io/records.h"
#include "vantage/io/scan_formats.h"

namespace vantage {
namespace {

/// Smallest record of each point format (LAS 1.4 R15, tables 7 to 17).
constexpr std::size_t kRecordBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

struct LasHeader {
  int minor = 0;
  std::uint64_t points_begin = 0, points = 0, record = 0;
  unsigned format = 0;
  Vec<3> scale, offset;
};

std::uint64_t number_of_points(const FileBytes& file, int minor) {
  const std::uint64_t legacy = file.number<std::uint32_t>(107, "the header");
  if (minor < 4) return legacy;
  const auto wide = file.number<std::uint64_t>(247, "the header");
  return wide == 0 ? legacy : wide;
}

void check_header(const FileBytes& file, const LasHeader& header, std::uint64_t header_size) {
  const std::uint64_t least = header.minor >= 4 ? 375 : header.minor == 3 ? 235 : 227;
  if (header_size < least || header_size > file.size())
    file.fail(94, fmt::format("header of {} bytes: must be {} or more, within the file", header_size, least));
  if (header.points_begin < header_size || header.points_begin > file.size())
    file.fail(96, fmt::format("points begin at byte {}: must be from {} to {}", header.points_begin, header_size, file.size()));
  if (header.format >= std::size(kRecordBytes)) file.fail(104, fmt::format("point format {}: must be 0 to 10", header.format));
  if (header.record < kRecordBytes[header.format])
    file.fail(105, fmt::format("records of {} bytes: point format {} needs {}", header.record, header.format, kRecordBytes[header.format]));
  if (header.points > (file.size() - header.points_begin) / header.record)
    file.fail(header.points_begin,
              fmt::format("{} points of {} bytes exceed the file, which has {} bytes", header.points, header.record, file.size()));
  for (int a = 0; a < 3; ++a) {
    if (!std::isfinite(header.scale[a]) || header.scale[a] == 0.0)
      file.fail(static_cast<std::uint64_t>(131 + 8 * a), fmt::format("scale {}: must be finite and not 0", header.scale[a]));
    if (!std::isfinite(header.offset[a]))
      file.fail(static_cast<std::uint64_t>(155 + 8 * a), fmt::format("offset {}: must be finite", header.offset[a]));
  }
}

LasHeader parse_header(const FileBytes& file) {
  LasHeader header;
  const auto major = file.number<std::uint8_t>(24, "the header");
  header.minor = file.number<std::uint8_t>(25, "the header");
  if (major != 1 || header.minor > 4) file.fail(24, fmt::format("LAS {}.{}: must be 1.0 to 1.4", major, header.minor));
  const auto format = file.number<std::uint8_t>(104, "the header");
  if ((format & 0xc0) != 0)
    file.fail(
        104,
        "compressed (LAZ): `vantage-convert IN.laz OUT.las` of the Python package (pip install ./python) decompresses it; this program reads LAS");
  header.format = format;
  header.points_begin = file.number<std::uint32_t>(96, "the header");
  header.record = file.number<std::uint16_t>(105, "the header");
  for (int a = 0; a < 3; ++a) {
    header.scale[a] = file.number<double>(static_cast<std::uint64_t>(131 + 8 * a), "the header");
    header.offset[a] = file.number<double>(static_cast<std::uint64_t>(155 + 8 * a), "the header");
  }
  header.points = number_of_points(file, header.minor);
  check_header(file, header, file.number<std::uint16_t>(94, "the header"));
  return header;
}

}  // namespace

std::vector<MeasuredScan> parse_las(FileBytes file) {
  const LasHeader header = parse_header(file);
  const std::string_view data = file.all().substr(header.points_begin);
  MeasuredScan scan;
  scan.name = file.where();
  scan.format = fmt::format("LAS 1.{}, point format {}", header.minor, header.format);
  PointColumns columns;
  for (int a = 0; a < 3; ++a)
    columns[static_cast<std::size_t>(a)] =
        NumberColumn{static_cast<std::size_t>(4 * a), header.record, NumberType::int32, header.scale[a], header.offset[a]};
  scan.points = widen_points(data, header.points, columns, file.where());
  scan.epsg = las_epsg(file);
  return {std::move(scan)};
}

}  // namespace vantage
