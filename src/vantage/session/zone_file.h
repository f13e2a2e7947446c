// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/geometry/zone.h"

namespace vantage {

/// The polygons of a file, in its own coordinates, all heights, not tidied. GeoJSON (`.geojson`, `.json`): every Polygon and MultiPolygon, with
/// holes, of a FeatureCollection, Feature, GeometryCollection or bare geometry; heights are passed over. Otherwise text: a corner `x,y` a line, or
/// columns named x and y (east, north) by a first line; an empty line begins the next polygon. Throws io, or bad_input naming the member or the line;
/// so for longitudes and latitudes: a system known to count in degrees, or no system (RFC 7946) where all numbers may be degrees. `"crs": null`,
/// which was to say that nothing is known, stands for the coordinates of the scans.
[[nodiscard]] std::vector<Zone> read_zones(const std::filesystem::path& path);
[[nodiscard]] std::vector<Zone> parse_geojson_zones(std::string_view text, const std::string& where);
[[nodiscard]] std::vector<Zone> parse_csv_zones(std::string_view text, const std::string& where);

/// Whether the name ends as that of such a file.
[[nodiscard]] bool names_zone_file(std::string_view name);

}  // namespace vantage
