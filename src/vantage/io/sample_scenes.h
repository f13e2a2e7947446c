// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/io/bytes.h"

/// Tiny scene files of the formats with structure, for tests, mutations and seeds of the fuzzers.
namespace vantage::samples {

/// A house of 4 x 4 x 3 m around a court of 2 x 2 m, far from the origin: floor and roof have holes. Beside it a block as its coarser level, a lawn,
/// a part, a tree placed twice, and a line, which has no surface.
inline std::string cityjson() {
  return R"({"type":"CityJSON","version":"2.0",
"transform":{"scale":[0.001,0.001,0.001],"translate":[84616.5,447423.0,-0.5]},
"CityObjects":{
"house":{"type":"Building","children":["part"],"geometry":[
 {"type":"Solid","lod":"1.2","boundaries":[[[[0,1,2,3]],[[8,9,10,11]]]]},
 {"type":"Solid","lod":"2","boundaries":[[[[3,2,1,0],[4,5,6,7]],[[8,9,10,11],[15,14,13,12]],[[0,1,9,8]],[[1,2,10,9]],[[2,3,11,10]],[[3,0,8,11]],
 [[4,12,13,5]],[[5,13,14,6]],[[6,14,15,7]],[[7,15,12,4]]]]}]},
"whole":{"type":"Building","children":["part"],"geometry":[{"type":"CompositeSurface","lod":1,"boundaries":[[[0,1,2]]]}]},
"part":{"type":"BuildingPart","parents":["whole"],"geometry":[{"type":"MultiSolid","lod":"2","boundaries":[[[[[16,17,18]],[[16,17,19]]]]]}]},
"lawn":{"type":"LandUse","geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[16,17,18,19]]]},{"type":"MultiLineString","lod":"3","boundaries":[[0,1]]}]},
"tree":{"type":"SolitaryVegetationObject","geometry":[
 {"type":"GeometryInstance","template":0,"boundaries":[18],"transformationMatrix":[2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1]},
 {"type":"GeometryInstance","template":0,"boundaries":[17],"transformationMatrix":[1,0,0,0, 0,1,0,0, 0,0,1,5, 0,0,0,1]}]}},
"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,0,1]]},
"vertices":[[0,0,0],[4000,0,0],[4000,4000,0],[0,4000,0],[1000,1000,0],[3000,1000,0],[3000,3000,0],[1000,3000,0],
[0,0,3000],[4000,0,3000],[4000,4000,3000],[0,4000,3000],[1000,1000,3000],[3000,1000,3000],[3000,3000,3000],[1000,3000,3000],
[10000,0,0],[16000,0,0],[16000,6000,0],[10000,6000,0]]}
)";
}

/// A wall with a window's hole (level 2, by boundedBy) that its solid links to, the block of level 1, a part, a relief of two triangles and a tree by
/// a template.
inline std::string citygml() {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0" xmlns:bldg="b" xmlns:g="http://www.opengis.net/gml" xmlns:dem="d" xmlns:xlink="x">
<g:boundedBy><g:Envelope srsDimension="3"><g:lowerCorner>0 0 0</g:lowerCorner><g:upperCorner>9 9 9</g:upperCorner></g:Envelope></g:boundedBy>
<core:cityObjectMember><bldg:Building g:id="B">
<bldg:lod1Solid><g:Solid><g:exterior><g:CompositeSurface><g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>
0 0 0 8 0 0 8 0 9 0 0 9 0 0 0</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember></g:CompositeSurface></g:exterior></g:Solid></bldg:lod1Solid>
<bldg:lod2Solid><g:Solid><g:exterior><g:CompositeSurface><g:surfaceMember xlink:href="#wall"/></g:CompositeSurface></g:exterior></g:Solid></bldg:lod2Solid>
<bldg:boundedBy><bldg:WallSurface><bldg:lod2MultiSurface><g:MultiSurface srsDimension="3"><g:surfaceMember>
<g:Polygon g:id="wall"><g:exterior><g:LinearRing><g:pos>1000 2000 0</g:pos><g:pos>1004 2000 0</g:pos><g:pos>1004 2000 3</g:pos><g:pos>1000 2000 3</g:pos>
<g:pos>1000 2000 0</g:pos></g:LinearRing></g:exterior><g:interior><g:LinearRing><g:posList>1001 2000 1 1002 2000 1 1002 2000 2 1001 2000 2 1001 2000 1
</g:posList></g:LinearRing></g:interior></g:Polygon></g:surfaceMember></g:MultiSurface></bldg:lod2MultiSurface>
<bldg:opening><bldg:Window><bldg:lod2MultiSurface><g:MultiSurface><g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList srsDimension="3">
1001 2000 1 1002 2000 1 1002 2000 2 1001 2000 1</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember></g:MultiSurface></bldg:lod2MultiSurface>
</bldg:Window></bldg:opening></bldg:WallSurface></bldg:boundedBy>
</bldg:Building></core:cityObjectMember>
<core:cityObjectMember><dem:ReliefFeature><dem:reliefComponent><dem:TINRelief><dem:extent><g:Polygon><g:exterior><g:LinearRing><g:posList>
0 0 0 99 0 0 99 99 0 0 0 0</g:posList></g:LinearRing></g:exterior></g:Polygon></dem:extent><dem:tin><g:TriangulatedSurface><g:trianglePatches>
<g:Triangle><g:exterior><g:LinearRing><g:posList>1000 1990 0 1010 1990 0 1010 2000 0 1000 1990 0</g:posList></g:LinearRing></g:exterior></g:Triangle>
<g:Triangle><g:exterior><g:LinearRing><g:posList>1000 1990 0 1010 2000 0 1000 2000 0 1000 1990 0</g:posList></g:LinearRing></g:exterior></g:Triangle>
</g:trianglePatches></g:TriangulatedSurface></dem:tin></dem:TINRelief></dem:reliefComponent></dem:ReliefFeature></core:cityObjectMember>
<core:cityObjectMember><veg><lod1ImplicitRepresentation><core:ImplicitGeometry><core:transformationMatrix>2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1
</core:transformationMatrix><core:relativeGMLGeometry><g:MultiSurface g:id="leaf"><g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>
0 0 0 1 0 0 0 0 1 0 0 0</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember></g:MultiSurface></core:relativeGMLGeometry>
<core:referencePoint><g:Point><g:pos>1005 1995 0</g:pos></g:Point></core:referencePoint></core:ImplicitGeometry></lod1ImplicitRepresentation></veg>
<veg><lod1ImplicitRepresentation><core:ImplicitGeometry><core:relativeGMLGeometry xlink:href="#leaf"/><core:referencePoint><g:Point><g:pos>1007 1995 0</g:pos>
</g:Point></core:referencePoint></core:ImplicitGeometry></lod1ImplicitRepresentation></veg></core:cityObjectMember>
</core:CityModel>
)";
}

inline std::string obj() { return "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 1\nf 1 2 3 4\nf 1//1 2//1 -1 # a roof\n"; }
inline std::string off() { return "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"; }
inline std::string stl() {
  return "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
}
inline std::string dae() {
  return R"(<COLLADA version="1.4.1"><asset><unit meter="0.0254"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common><accessor source="#f" count="4" stride="3"/>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><matrix>1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

/// Six corners as floats, then six indices: a strip of two triangles and a fan; a child that is turned, and one moved by a matrix.
inline std::string gltf_buffer() {
  std::string out;
  for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 1.F, 1.F, 0.F, 0.F, 0.F, 1.F, 1.F, 0.F, 1.F}) put(out, v);
  for (std::uint16_t i = 0; i < 6; ++i) put(out, i);
  return out;
}
inline std::string gltf(const std::string& buffer) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"children":[1,2]},
{"mesh":0,"rotation":[0,0,1,0],"translation":[1,2,3],"scale":[2,2,2]},{"mesh":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5}]},{"primitives":[{"attributes":{"POSITION":2},"mode":6},
{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":84)" +
         buffer + R"(}],"bufferViews":[{"buffer":0,"byteLength":72,"byteStride":12},{"buffer":0,"byteOffset":72,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3"},{"bufferView":1,"byteOffset":2,"componentType":5123,"count":4,"type":"SCALAR"},
{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":0,
"byteOffset":60}}}]})";
}
/// The container of both, as a `.glb`.
inline std::string packed_glb(std::string json, const std::string& binary) {
  std::string out = "glTF";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  put<std::uint32_t>(out, 2);
  put(out, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  put(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(binary.size()));
  return out + std::string("BIN\0", 4) + binary;
}
inline std::string glb() { return packed_glb(gltf(""), gltf_buffer()); }
/// The buffer as text: all floats are 0 or 1, all indices small.
inline std::string gltf() {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string bytes = gltf_buffer();
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | static_cast<unsigned char>(bytes[i + k]);
    for (const int shift : {18, 12, 6, 0}) text += kDigits[bits >> shift & 63];
  }
  return gltf(R"(,"uri":"data:application/octet-stream;base64,)" + text + "\"");
}

/// Name (whose ending tells the format) and bytes of each.
inline std::vector<std::pair<std::string, std::string>> scenes() {
  return {{"court.json", cityjson()}, {"wall.gml", citygml()}, {"roof.obj", obj()},    {"square.off", off()},
          {"corner.stl", stl()},      {"square.dae", dae()},   {"strip.gltf", gltf()}, {"strip.glb", glb()}};
}

}  // namespace vantage::samples
