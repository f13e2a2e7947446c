// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/geojson.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "vantage/base/error.h"

namespace vantage {
namespace {

TEST(GeoJson, HoldsPointsAndLinesWithAllDigits) {
  const MapFeature features[] = {{{{512345.123456789, 5.4e6, 1.75}}, {{"kind", "station"}, {"id", std::int64_t{3}}}},
                                 {{{0, 0, 0}, {1, 2, 3}}, {{"kind", "path \"\xff"}}}};
  const nlohmann::json json = nlohmann::json::parse(features_as_geojson(features, 25832));
  EXPECT_EQ(json["type"], "FeatureCollection");
  EXPECT_EQ(json["crs"]["properties"]["name"], "urn:ogc:def:crs:EPSG::25832");
  EXPECT_EQ(json["features"][0]["geometry"], nlohmann::json::parse(R"({"type": "Point", "coordinates": [512345.123456789, 5.4e6, 1.75]})"));
  EXPECT_EQ(json["features"][0]["properties"], nlohmann::json::parse(R"({"kind": "station", "id": 3})"));
  EXPECT_EQ(json["features"][1]["geometry"], nlohmann::json::parse(R"({"type": "LineString", "coordinates": [[0, 0, 0], [1, 2, 3]]})"));
  EXPECT_EQ(nlohmann::json::parse(features_as_geojson({}, 25832))["features"].size(), 0U);
}

TEST(GeoJson, CodesAreOfProjectedSystems) {
  EXPECT_EQ(parse_epsg("EPSG:25832", "--crs"), 25832);
  EXPECT_EQ(parse_epsg("epsg:4647", "--crs"), 4647);
  EXPECT_EQ(parse_epsg("2056", "--crs"), 2056);
  for (const char* text :
       {"", "EPSG:", "EPSG:x", "EPSG:25832x", "EPSG:-1", "EPSG:1023", "EPSG:32767", "EPSG:99999999999", "utm32", "EPSG:4326", "4258"})
    EXPECT_THROW((void)parse_epsg(text, "--crs"), Error) << text;
}

}  // namespace
}  // namespace vantage
