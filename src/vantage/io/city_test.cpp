// SPDX-License-Identifier: Apache-2.0
// CityJSON and CityGML.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>

#include "vantage/base/error.h"
#include "vantage/io/mesh_file.h"
#include "vantage/io/sample_scenes.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

using testing::HasSubstr;

double area(const Mesh<3>& mesh) {
  double sum = 0.0;
  for (const auto& f : mesh.facets) sum += 0.5 * (mesh.vertices[f[1]] - mesh.vertices[f[0]]).cross(mesh.vertices[f[2]] - mesh.vertices[f[0]]).norm();
  return sum;
}

Mesh<3> read(const std::string& text, const std::string& name, double detail = -1.0) {
  MeshFileOptions options;
  options.detail = detail;
  return parse_mesh(text, name, options);
}

/// The error, one line; fails if there is none.
std::string error_of(const std::string& text, const std::string& name) {
  try {
    (void)read(text, name);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.where() + " | " + error.what();
  }
  ADD_FAILURE() << "no error: " << text.substr(0, 200);
  return {};
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

constexpr double kCourt = 2 * (16.0 - 4.0) + 4 * 12.0 + 4 * 6.0;  // Floor and roof with their holes, outer and inner walls.
constexpr double kPart = 18.0 + 18.0, kLawn = 36.0, kTrees = 0.5 * 4.0 + 0.5;

TEST(CityJson, HighestLevelOfEachObjectWithHolesAndTemplates) {
  const Mesh<3> mesh = read(samples::cityjson(), "a.city.json");
  EXPECT_NEAR(area(mesh), kCourt + kPart + kLawn + kTrees, 1e-6);
  const Box<3> box = mesh.bounds();
  EXPECT_NEAR((box.low - Vec<3>(84616.5, 447423.0, -0.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((box.high - Vec<3>(84634.5, 447429.0, 5.5)).norm(), 0.0, 1e-9);  // The tree, 2 m wide, and the one put 5 m higher.
}

TEST(CityJson, ALevelCanBeChosen) {
  const double block = 32.0, whole = 8.0;
  // Nothing at or below level 1 but the lawn and the whole: the house at its lowest, the part as it is, with its whole left to it.
  EXPECT_NEAR(area(read(samples::cityjson(), "a.json", 1.0)), block + kPart + kLawn + kTrees, 1e-6);
  EXPECT_NEAR(area(read(samples::cityjson(), "a.json", 1.9)), block + kPart + kLawn + kTrees, 1e-6);
  EXPECT_NEAR(area(read(samples::cityjson(), "a.json", 2.0)), kCourt + kPart + kLawn + kTrees, 1e-6);
  // Without the part the whole is shown.
  const std::string alone = changed(samples::cityjson(), "\"type\":\"BuildingPart\",\"parents\":[\"whole\"]", "\"type\":\"BuildingPart\"");
  EXPECT_NEAR(area(read(alone, "a.json")), kCourt + kPart + kLawn + kTrees + whole, 1e-6);
}

TEST(CityJson, VersionOneHasNoTransform) {
  const std::string text = R"({"type":"CityJSON","version":"1.0","CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":2.2,
    "boundaries":[[[0,1,2]]]}]}},"vertices":[[500000.25,0,0],[500001.25,0,0],[500000.25,2,0]]})";
  const Mesh<3> mesh = read(text, "a.json");
  EXPECT_NEAR(area(mesh), 1.0, 1e-9);
  EXPECT_EQ(mesh.vertices[0], Vec<3>(500000.25, 0, 0));
}

TEST(CityJson, ErrorsNameThePlace) {
  const std::string good = samples::cityjson();
  const struct {
    std::string from, to, where, says;
  } cases[] = {
      {"[[3,2,1,0],[4,5,6,7]]", "[[3,2,1,0],[4,5,6,20]]", "a.json:/CityObjects/house/geometry/1/boundaries/0/0/1/3", "20: must be 0 .. 19"},
      {"[[3,2,1,0],[4,5,6,7]]", "[[3,2,1,-1]]", "a.json:/CityObjects/house/geometry/1/boundaries/0/0/0/3", "-1: must be 0 .. 19"},
      {"[[3,2,1,0],[4,5,6,7]]", "[[3,2,1,1.5]]", "a.json:/CityObjects/house/geometry/1/boundaries/0/0/0/3", "1.5: must be 0 .. 19"},
      {"[[3,2,1,0],[4,5,6,7]]", "[3,2,1,0]", "a.json:/CityObjects/house/geometry/1/boundaries/0/0/0", "3: must be an array"},
      {"[4000,0,0]", "[4000,0]", "a.json:/vertices/1", "must be 3 numbers"},
      {"[4000,0,0]", "[4000,\"0\",0]", "a.json:/vertices/1/1", "\"0\": must be a number"},
      {"\"vertices\"", "\"vertexes\"", "a.json", "lacks \"vertices\""},
      {"\"CityObjects\"", "\"Objects\"", "a.json", "lacks \"CityObjects\""},
      {"\"translate\":[84616.5,447423.0,-0.5]", "\"translate\":[84616.5]", "a.json:/transform/translate", "must be 3 numbers"},
      {"\"lod\":\"1.2\"", "\"lod\":\"high\"", "a.json:/CityObjects/house/geometry/0/lod", "level of detail"},
      {"\"template\":0", "\"template\":7", "a.json:/CityObjects/tree/geometry/0/template", "7: must be 0 .. 0"},
      {"\"boundaries\":[18]", "\"boundaries\":[99]", "a.json:/CityObjects/tree/geometry/0/boundaries/0", "99: must be 0 .. 19"},
      {"2,0,0,0, ", "2,0,0, ", "a.json:/CityObjects/tree/geometry/0/transformationMatrix", "must be 16 numbers"},
      {"\"type\":\"CityJSON\"", "\"type\":\"FeatureCollection\"", "a.json", "not a CityJSON file"},
      {"\"type\":\"Solid\",", "", "a.json:/CityObjects/house/geometry/0", "lacks \"type\""},
  };
  for (const auto& c : cases) {
    const std::string error = error_of(changed(good, c.from, c.to), "a.json");
    EXPECT_THAT(error, HasSubstr(c.where + " | ")) << c.to;
    EXPECT_THAT(error, HasSubstr(c.says)) << c.to;
  }
  EXPECT_THAT(error_of(good.substr(0, 300), "a.json"), HasSubstr("a.json:300 | a.json:300: not JSON"));
  EXPECT_THAT(error_of("{}", "a.json"), HasSubstr("not a CityJSON file"));
  EXPECT_THAT(error_of("[1]", "a.json"), HasSubstr("not a CityJSON file"));
  EXPECT_THAT(error_of(std::string(100000, '['), "a.json"), HasSubstr("nests deeper than 100"));
  EXPECT_THAT(error_of("{\"asset\":" + std::string(100000, '['), "a.gltf"), HasSubstr("nests deeper than 100"));
  EXPECT_THAT(error_of(R"({"type":"CityJSON","CityObjects":{},"vertices":[]})", "a.json"), HasSubstr("holds no triangles"));
}

constexpr double kWall = 12.0 - 1.0, kWindow = 0.5, kRelief = 100.0, kLeaves = 0.5 * 4.0 + 0.5;

TEST(CityGml, HighestLevelWithHolesLinksReliefAndTemplates) {
  const Mesh<3> mesh = read(samples::citygml(), "a.gml");
  EXPECT_NEAR(area(mesh), kWall + kWindow + kRelief + kLeaves, 1e-6);
  EXPECT_NEAR((mesh.bounds().low - Vec<3>(1000, 1990, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((mesh.bounds().high - Vec<3>(1010, 2000, 3)).norm(), 0.0, 1e-9);
}

TEST(CityGml, ALevelCanBeChosen) { EXPECT_NEAR(area(read(samples::citygml(), "a.gml", 1.0)), 72.0 + kRelief + kLeaves, 1e-6); }

TEST(CityGml, AnyPrefixAndOldRings) {
  std::string text = samples::citygml();
  for (std::size_t at = 0; (at = text.find("g:", at)) != std::string::npos; at += 4)
    if (at > 0 && (text[at - 1] == '<' || text[at - 1] == '/' || text[at - 1] == ' ')) text.replace(at, 2, "gml3:");
  EXPECT_NEAR(area(read(text, "a.gml")), kWall + kWindow + kRelief + kLeaves, 1e-6);
  const std::string two = R"(<CityModel><x><Polygon><outerBoundaryIs><LinearRing><coordinates>0,0,0 1,0,0 1,1,0 0,1,0 0,0,0</coordinates></LinearRing>
    </outerBoundaryIs><innerBoundaryIs><LinearRing><coordinates>.25,.25,0 .5,.25,0 .5,.5,0</coordinates></LinearRing></innerBoundaryIs></Polygon></x></CityModel>)";
  EXPECT_NEAR(area(read(two, "a.gml")), 1.0 - 0.03125, 1e-12);
}

TEST(CityGml, ErrorsNameThePlace) {
  const std::string good = samples::citygml();
  const auto at = [&](const std::string& text, const std::string& what) { return "a.gml:" + std::to_string(text.find(what)); };
  const std::string odd = changed(good, "1001 2000 1 1002 2000 1 1002 2000 2 1001 2000 2", "1001 2000 1 1002 2000 1 1002 2000");
  EXPECT_THAT(error_of(odd, "a.gml"), HasSubstr(at(odd, "g:posList>1001 2000 1 1002 2000 1 1002 2000 1001")));
  EXPECT_THAT(error_of(odd, "a.gml"), HasSubstr("11 numbers: positions have 3 each"));
  EXPECT_THAT(error_of(changed(good, "1002 2000 2 ", "1002 two 2 "), "a.gml"), HasSubstr("'two': must be a finite number"));
  EXPECT_THAT(error_of(changed(good, "1002 2000 2 ", "1e999 2000 2 "), "a.gml"), HasSubstr("'1e999': must be a finite number"));
  EXPECT_THAT(error_of(changed(good, "<g:posList srsDimension=\"3\">", "<g:posList srsDimension=\"2\">"), "a.gml"),
              HasSubstr("positions of 2 numbers"));
  EXPECT_THAT(error_of(changed(good, "2 0 0 0 0 2", "2 0 0 0 2"), "a.gml"), HasSubstr("15 numbers: a matrix has 16"));
  EXPECT_THAT(error_of(changed(good, "1005 1995 0", "1005 1995"), "a.gml"), HasSubstr("2 numbers: a position has 3"));
  EXPECT_THAT(error_of(good.substr(0, 2000), "a.gml"), HasSubstr("not well-formed XML"));
  EXPECT_THAT(error_of("<kml><Polygon/></kml>", "a.gml"), HasSubstr("begins with <kml>"));
  EXPECT_THAT(error_of("<a:CityModel/>", "a.gml"), HasSubstr("holds no triangles"));
  EXPECT_THAT(error_of("nothing", "a.gml"), HasSubstr("not well-formed XML"));
}

TEST(CityGml, LinksThatLeadBackEnd) {
  std::string text = "<CityModel xmlns:xlink='x'>";
  for (int level = 0; level < 9; ++level) {
    text += "<a id='g" + std::to_string(level) + "'>";
    for (int k = 0; k < 60; ++k) text += "<m xlink:href='#g" + std::to_string((level + 1 + k % 3) % 9) + "'/>";
    text += "</a>";
  }
  const std::string placed =
      "<lod1ImplicitRepresentation><ImplicitGeometry><transformationMatrix>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1</transformationMatrix>"
      "<relativeGMLGeometry xlink:href='#g0'/></ImplicitGeometry></lod1ImplicitRepresentation>";
  EXPECT_THAT(error_of(text + placed + "</CityModel>", "a.gml"), HasSubstr("holds no triangles"));
  EXPECT_THAT(error_of(text + "<a id='g1'>" + placed + "</a>" + placed + "</CityModel>", "a.gml"), HasSubstr("holds no triangles"));
  EXPECT_THAT(error_of("<CityModel><a id='g0'>" + placed + "</a></CityModel>", "a.gml"), HasSubstr("a template within a template"));
  std::string chain = "<CityModel><lod1Solid xlink:href='#c0'/>";
  for (int k = 0; k < 1000; ++k) chain += "<c id='c" + std::to_string(k) + "' xlink:href='#c" + std::to_string(k + 1) + "'/>";
  EXPECT_THAT(error_of(chain + "</CityModel>", "a.gml"), HasSubstr("more than 100 in a row"));
}

TEST(CityModels, RealOnes) {
  VANTAGE_NEEDS_DATA("delft_cityjson");
  VANTAGE_NEEDS_DATA("lod3_building_citygml");
  const Mesh<3> delft = read_mesh(data_set("delft_cityjson") / "delft.json");
  EXPECT_EQ(delft.facets.size(), 36271U);
  EXPECT_NEAR((delft.bounds().low - Vec<3>(84616.468, 447422.999, -0.452)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((delft.bounds().high - Vec<3>(85140.839, 447750.636, 16.846)).norm(), 0.0, 1e-6);
  const Mesh<3> house = read_mesh(data_set("lod3_building_citygml") / "lod3_building_v2.gml");
  EXPECT_EQ(house.facets.size(), 3092U);
  EXPECT_NEAR((house.bounds().low - Vec<3>(202.42961441, 244.634403648, -0.693008422852)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((house.bounds().high - Vec<3>(218.556788788, 256.44312233, 21.4020614624)).norm(), 0.0, 1e-6);
}

}  // namespace
}  // namespace vantage
