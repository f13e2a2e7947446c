// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "vantage/geometry/vec.h"

namespace vantage {

/// A point (one place) or a line (more) of a map.
struct MapFeature {
  std::vector<Vec<3>> places;  ///< (N, 3) [unit of the coordinate system].
  std::vector<std::pair<std::string, std::variant<std::int64_t, std::string>>> properties;
};

/// GeoJSON in the projected coordinate system EPSG:`epsg`, named by the member "crs" of the 2008 format: QGIS and GDAL put the features where they
/// belong. (RFC 7946 dropped the member and allows WGS 84 degrees only, which would need the formulas of every projection.) All digits are kept.
[[nodiscard]] std::string features_as_geojson(std::span<const MapFeature> features, int epsg);

/// The code of "EPSG:25832" or "25832". Throws bad_input at `where` for another text and for systems known to count in degrees or from the centre of
/// the Earth, whose coordinates are no places in metres or feet.
[[nodiscard]] int parse_epsg(std::string_view text, std::string_view where);

}  // namespace vantage
