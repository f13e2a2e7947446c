// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/geojson.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "vantage/base/error.h"
#include "vantage/io/text.h"
#include "vantage/io/text_scanner.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kLargestCode = 32766;  // That GeoTIFF keys can name.

/// Common systems of longitude and latitude or geocentric coordinates: WGS 84, ETRS89, NAD27 and 83, GDA94 and 2020, RGF93, CGCS2000, JGD2011.
constexpr int kNotProjected[] = {4258, 4267, 4269, 4283, 4326, 4171, 4490, 4936, 4937, 4978, 4979, 6668, 7844};

Json coordinates(const Vec<3>& p) { return {p[0], p[1], p[2]}; }

Json geometry(const MapFeature& feature) {
  if (feature.places.size() == 1) return {{"type", "Point"}, {"coordinates", coordinates(feature.places.front())}};
  Json line = Json::array();
  for (const Vec<3>& p : feature.places) line.push_back(coordinates(p));
  return {{"type", "LineString"}, {"coordinates", line}};
}

}  // namespace

std::string features_as_geojson(std::span<const MapFeature> features, int epsg) {
  Json all = Json::array();
  for (const MapFeature& feature : features) {
    Json properties = Json::object();
    for (const auto& [name, value] : feature.properties) std::visit([&](const auto& v) { properties[name] = v; }, value);
    all.push_back({{"type", "Feature"}, {"properties", properties}, {"geometry", geometry(feature)}});
  }
  const Json system = {{"type", "name"}, {"properties", {{"name", fmt::format("urn:ogc:def:crs:EPSG::{}", epsg)}}}};
  const Json json = {{"type", "FeatureCollection"}, {"crs", system}, {"features", all}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

int parse_epsg(std::string_view text, std::string_view where) {
  const std::string_view digits = text.starts_with("EPSG:") || text.starts_with("epsg:") ? text.substr(5) : text;
  const std::optional<int> code = to_number<int>(digits);
  require(code && *code >= 1024 && *code <= kLargestCode, fmt::format("{}: must be EPSG:1024 .. EPSG:{}", printable(text), kLargestCode), where);
  require(std::find(std::begin(kNotProjected), std::end(kNotProjected), *code) == std::end(kNotProjected),
          fmt::format("EPSG:{}: must be a projected system, whose coordinates are lengths", *code), where);
  return *code;
}

}  // namespace vantage
