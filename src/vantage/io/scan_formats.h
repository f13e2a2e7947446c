// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "vantage/io/bytes.h"
#include "vantage/io/scan_file.h"

namespace vantage {

/// ASPRS LAS 1.0 to 1.4, point formats 0 to 10: coordinates by scale and offset. LAZ is told and refused. Throws bad_input naming `where:offset`.
[[nodiscard]] std::vector<MeasuredScan> parse_las(FileBytes file);

/// The EPSG code of a LAS file's projected coordinate system, from its GeoTIFF keys or its WKT; none: it names none, or not by a code.
[[nodiscard]] std::optional<int> las_epsg(FileBytes file);

/// Leica PTX, several scans a file: columns, rows, a rigid motion, then a line per ray; `0 0 0` is no return. Throws bad_input naming `where:line`.
[[nodiscard]] std::vector<MeasuredScan> parse_ptx(std::string_view bytes, std::string_view where);

/// Raw records of KITTI: x y z reflectance, or x y z, as 4-byte floats, without a header; which one is told by size and plausibility.
/// Throws bad_input if neither fits.
[[nodiscard]] std::vector<MeasuredScan> parse_kitti(FileBytes file);

/// ASTM E2807 (E57): every page's checksum is verified; cartesian or spherical coordinates, poses, invalid states, row and column indices,
/// coordinateMetadata. Throws bad_input naming `where:offset`, or `where` and the element of its XML part.
[[nodiscard]] std::vector<MeasuredScan> parse_e57(FileBytes file);

/// Centres of the occupied leaves of an OctoMap file (octomap.h).
[[nodiscard]] std::vector<MeasuredScan> parse_octomap(FileBytes file);

/// Whether a text begins like PTX: two lines of one whole number, four of three numbers, one of four.
[[nodiscard]] bool looks_like_ptx(std::string_view bytes);

}  // namespace vantage
