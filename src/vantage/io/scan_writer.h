// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/io/scan_file.h"

namespace vantage {

/// How points are written; each option concerns the formats named.
struct ScanWriteOptions {
  bool ascii = false;  ///< PLY and PCD: numbers as text instead of binary.
  /// PLY and PCD: exact: floats if every coordinate is one, else doubles.
  enum class Number { exact, float32, float64 } number = Number::exact;
  double resolution = 0.0;  ///< LAS: coordinates become multiples of it [file's unit]; 0: 0.0001, or the next power of ten that fits the extent.
  int las_minor = 0;        ///< LAS 1.2 or 1.4; 0: 1.2, and 1.4 for more points than 1.2 can count.
  std::optional<int> epsg = std::nullopt;  ///< LAS: the coordinate system, as GeoTIFF keys.
};

/// A file's bytes, and what was lost on the way.
struct WrittenScans {
  std::string bytes;
  std::string precision;              ///< "doubles", "multiples of 0.0001" …
  std::vector<std::string> left_out;  ///< What the scans know and the format does not hold: "6 poses" …
};

/// The format that a name's ending asks for: "PLY", "PCD", "LAS", "XYZ" (.xyz, .txt, .asc) or "CSV"; none: no such ending.
[[nodiscard]] std::optional<std::string_view> written_scan_format(std::string_view name);

/// All scans in one file of a `written_scan_format`; docs/12-files.md says what each format keeps. A plane (all scans of dim 2) stays one, but in
/// LAS. Throws bad_input: an extent that LAS cannot hold at the resolution asked, more points than LAS 1.2 counts.
[[nodiscard]] WrittenScans scans_as(std::string_view format, std::span<const MeasuredScan> scans, const ScanWriteOptions& options = {});

}  // namespace vantage
