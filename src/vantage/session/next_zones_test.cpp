// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/next_zones.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/error.h"
#include "vantage/session/zone_file.h"

namespace vantage {
namespace {

using testing::HasSubstr;

template <class Body>
std::string error_of(Body&& body) {
  try {
    static_cast<void>(body());
  } catch (const Error& error) {
    return error.where() + ": " + error.what();
  }
  return {};
}

TEST(NextZones, SettleToWhatTheyAre) {
  const std::string text = "0,0,0,1,1,1; 0,0 4,0 4.5,3 z=0..2.5 ; 0,0 9,0 9,9 0,9 / 3,3 4,3 4,4";
  const std::string settled = settled_zones(text, {}, "--keep-out");
  EXPECT_EQ(settled, "0,0,0,1,1,1; 0,0 4,0 4.5,3 z=0..2.5; 0,0 9,0 9,9 0,9 / 3,3 4,3 4,4");
  EXPECT_EQ(settled_zones(settled, {}, "--keep-out"), settled);
  const std::vector<Zone> zones = zones_of<3>(settled, "--keep-out");
  ASSERT_EQ(zones.size(), 3U);
  EXPECT_EQ(zones[0].high, 1.0);
  EXPECT_EQ(zones[1].high, 2.5);
  EXPECT_EQ(zones[1].rings[0][2], Vec<2>(4.5, 3.0));
  EXPECT_EQ(zones[2].rings.size(), 2U);
  EXPECT_EQ(zones[2].high, kInfinity);
  EXPECT_EQ(zones_of<2>("0,0,1,1,2,2,3,3", "").size(), 2U);
  EXPECT_TRUE(zones_of<3>("", "").empty());
}

TEST(NextZones, CountInTheCoordinatesOfTheFiles) {
  MeasuredOptions options;
  options.unit = 0.5;
  const auto zone = [&](MeasuredOptions::Up up) {
    options.up = up;
    return zones_of<3>(settled_zones("2,4 8,4 8,6 z=1..3", options, ""), "").at(0);
  };
  using Up = MeasuredOptions::Up;
  for (const Up up : {Up::x, Up::y, Up::z, Up::down}) {
    // The same corners by the way that points of scans take: in place of the two level axes.
    Eigen::Index axis = 0;
    upright(up).row(2).cwiseAbs().maxCoeff(&axis);
    const Zone found = zone(up);
    std::vector<double> heights;
    for (const double h : {1.0, 3.0}) {
      Vec<3> p = Vec<3>::Constant(h);
      p[axis == 0 ? 1 : 0] = 8.0;
      p[axis == 2 ? 1 : 2] = 6.0;
      const Vec<3> world = upright(up) * p * options.unit;
      EXPECT_EQ(found.rings[0][2], world.head<2>());
      heights.push_back(world[2]);
    }
    std::sort(heights.begin(), heights.end());
    EXPECT_EQ(std::vector({found.low, found.high}), heights);
  }
}

TEST(NextZones, FilesHoldPolygons) {
  const auto zones = parse_geojson_zones(
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},"features":[
        {"type":"Feature","geometry":null,"properties":null},
        {"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]},"properties":{}},
        {"type":"Feature","geometry":{"type":"GeometryCollection","geometries":[{"type":"MultiPolygon","coordinates":[
          [[[0,0],[9,0],[9,9],[0,0]],[[5,1],[7,1],[7,3],[5,1]]],[[[20,0,5],[29,0,5],[29,9,5]]]]}]},"properties":{}}]})",
      "f.json");
  ASSERT_EQ(zones.size(), 2U);
  EXPECT_EQ(zones[0].rings.size(), 2U);
  EXPECT_EQ(zones[0].rings[0].size(), 3U);  // The last corner repeats the first.
  EXPECT_EQ(zones[1].rings[0][1], Vec<2>(29, 0));
  EXPECT_EQ(parse_geojson_zones(R"({"type":"Polygon","coordinates":[[[0,0],[500000,0],[500000,9]]]})", "f").size(), 1U);  // No degrees.
  EXPECT_EQ(parse_csv_zones("Y;X\r\n1;2\r\n3;4\r\n1;9\r\n\r\n\r\n5;5\r\n6;5\r\n6;6\r\n", "f").size(), 2U);
  EXPECT_EQ(parse_csv_zones("north east id\n1 2 a\n3 4 a\n1 9 a\n", "f")[0].rings[0][0], Vec<2>(2, 1));
}

TEST(NextZones, ErrorsNameThePlace) {
  EXPECT_THAT(error_of([] { return parse_geojson_zones("{\"type\":", "f"); }), HasSubstr("f:8: not JSON"));
  EXPECT_THAT(error_of([] { return parse_geojson_zones("[]", "f"); }), HasSubstr("f:/: must be an object"));
  EXPECT_THAT(error_of([] { return parse_geojson_zones(R"({"type":"Polygon"})", "f"); }), HasSubstr("has no \"coordinates\""));
  EXPECT_THAT(error_of([] { return parse_geojson_zones(R"({"type":"Polygon","coordinates":[[[0,0],[9,0]]]})", "f"); }),
              HasSubstr("f:/coordinates: 2 corners"));
  EXPECT_THAT(error_of([] { return parse_geojson_zones(R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":7}]})", "f"); }),
              HasSubstr("f:/features/0/geometry: must be an object"));
  std::string deep = R"({"type":"Polygon","coordinates":[]})";
  for (int k = 0; k < 3000; ++k) deep = R"({"type":"Feature","geometry":)" + deep + "}";
  EXPECT_THAT(error_of([&] { return parse_geojson_zones(deep, "f"); }), HasSubstr("nests deeper than 100"));
  EXPECT_THAT(error_of([] { return parse_csv_zones("0,0\n1,0\n\n2,2\n", "f"); }), HasSubstr("f:1: 2 corners"));
  EXPECT_THAT(error_of([] { return parse_csv_zones("lon,lat\n1,0\n", "f"); }), HasSubstr("names the columns x and y"));
  EXPECT_THAT(error_of([] { return zones_of<3>("1,1,1,0,0,0", "--must-see"); }), HasSubstr("--must-see: the low corner must come first"));
}

}  // namespace
}  // namespace vantage
