// SPDX-License-Identifier: Apache-2.0
// fuzz_seeds FOLDER: writes FOLDER/READER/NAME, tiny valid files for every fuzzer.
#include <fmt/format.h>

#include <exception>

#include "vantage/exchange/publisher.h"
#include "vantage/exchange/test_clouds.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/npy.h"
#include "vantage/io/patch_file.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/sample_scenes.h"
#include "vantage/io/vti.h"
#include "vantage/session/sealed_log.h"

using namespace vantage;

namespace {

struct Seed {
  std::string reader, name, bytes;
};

std::string field() {
  const Grid<3> window{0.5, {-4, 2, 0}, {3, 4, 2}};
  const std::vector<float> psi(window.size(), 0.25F);
  const std::vector<std::uint8_t> state(window.size(), 1);
  const ImageArray arrays[] = {{"state", std::span<const std::uint8_t>(state)}, {"psi", std::span<const float>(psi)}};
  return image_as_vti<3>(window, arrays);
}

std::string array() {
  const std::int64_t nodes[] = {3, 2};
  return array_as_npy({"psi", std::vector<float>(6, 0.5F)}, nodes);
}

template <int Dim>
std::string map() {
  ExchangeMap all;
  Publisher<Dim> publisher("a", 0.1);
  for (const std::uint64_t seed : {1, 2}) all.add(publisher.publish(corner_scan<Dim>(12, Vec<Dim>::Zero(), seed)));
  return all.bytes();
}

template <int Dim>
std::string surface() {
  Patch<Dim> plane, point;
  for (int k = 0; k <= Dim; ++k) {
    Vec<Dim> corner = Vec<Dim>::Zero();
    if (k < Dim) corner[k] = 1.0;
    if (k < Dim) plane.vertices[static_cast<std::size_t>(k)] = corner;
  }
  plane.count = Dim;
  point.count = 1;
  const Patch<Dim> patches[] = {plane, point};
  return patches_as_ply<Dim>(patches);
}

/// The features of samples::scenes() one by one: half as long and twice as fast.
std::vector<Seed> city_seeds() {
  return {
      {"json", "hole.json",
       R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.5,1,1],"translate":[9,0,0]},"CityObjects":{"a":{"type":"Building","geometry":[)"
       R"({"type":"Solid","lod":"2","boundaries":[[[[0,1,2,3],[4,5,6]]]]}]}},"vertices":[[0,0,0],[9,0,0],[9,9,0],[0,9,0],[1,1,0],[2,1,0],[2,2,0]]})"},
      {"json", "part.json",
       R"({"type":"CityJSON","version":"1.0","CityObjects":{"a":{"type":"Building","geometry":[{"type":"CompositeSurface","lod":1,"boundaries":)"
       R"([[[0,1,2]]]}]},"b":{"type":"BuildingPart","parents":["a"],"geometry":[{"type":"MultiSolid","lod":"2","boundaries":[[[[[0,1,2]]]]]}]}},)"
       R"("vertices":[[0,0,0],[9,0,0],[9,9,0]]})"},
      {"json", "tree.json",
       R"({"type":"CityJSON","version":"1.1","CityObjects":{"a":{"type":"Tree","geometry":[{"type":"GeometryInstance","template":0,"boundaries":[0],)"
       R"("transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,5,0,0,0,1]}]}},"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2",)"
       R"("boundaries":[[[0,1,2]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,0,1]]},"vertices":[[1,2,3]]})"}};
}

/// A glTF of one triangle, three corners as floats and their indices as bytes, with these members; in `.glb` the buffer is a chunk of its own.
Seed triangle(const std::string& ending, const std::string& name, const std::string& members, const std::string& accessor) {
  std::string json = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],)" + members + R"(,"buffers":[{"byteLength":39)";
  if (ending == "gltf") json += R"(,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC")";
  json += R"(}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],)"
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3")" +
          accessor + R"(},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}]})";
  if (ending == "gltf") return {ending, name + ".gltf", json};
  std::string binary;
  for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) put(binary, v);
  binary += std::string("\0\1\2\0", 4);
  return {ending, name + ".glb", samples::packed_glb(json, binary)};
}

std::vector<Seed> triangle_seeds() {
  std::vector<Seed> seeds;
  for (const std::string ending : {"gltf", "glb"}) {
    seeds.push_back(triangle(
        ending, "matrix",
        R"("nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])",
        ""));
    seeds.push_back(triangle(ending, "child",
                             R"("nodes":[{"children":[1]},{"mesh":0,"rotation":[0,0,1,0],"translation":[1,2,3],"scale":[2,2,2]}],)"
                             R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}])",
                             R"(,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}})"));
  }
  return seeds;
}

std::vector<Seed> other_seeds() {
  return {
      {"vti", "a.vti", field()},
      {"npy", "a.npy", array()},
      {"map", "plane.map", map<2>()},
      {"map", "space.map", map<3>()},
      {"log", "plane.log", samples::scan_log<2>()},
      {"log", "space.log", samples::scan_log<3>()},
      {"surface", "plane.ply", surface<2>()},
      {"surface", "space.ply", surface<3>()},
      {"mesh", "square.ply",
       "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
       "vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"},
      {"image", "a.pgm", "P2 # a\n2 2\n15\n0 15 7 3\n"},
      {"image", "b.pgm", "P5\n2 1\n255\n\x01\x7f"},
      {"image", "a.png",
       std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDAT\x78\x9c\x63\xf8\x0f\0\1\1\1\0\xb1\x38\xf6"
                   "\x14\0\0\0\0IEND\xae\x42\x60\x82",
                   67)},
      {"poses", "places.csv", "# places\n1 2 3\n4,5,6\n"},
      {"poses", "named.csv", "name,tx,ty,tz,qw,qx,qy,qz\na,1,2,3,1,0,0,0\nb,1,2,3,0,1,0,0\n"},
      {"poses", "kitti.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n"},
      {"poses", "tum.txt", "0.5 1 2 3 0 0 0 1\n"},
      {"poses", "rows.txt", "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n"},
      {"yaml", "a.yaml",
       "image: a.png\nresolution: 0.05 # [m]\norigin: [-1, 2.5, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\nmode: trinary\n"},
      {"crs", "code.txt", "urn:ogc:def:crs:EPSG::25832"},
      {"crs", "one.txt", R"(PROJCS["a",GEOGCS["b",AUTHORITY["EPSG","4258"]],UNIT["m",1],AUTHORITY["EPSG","25832"]])"},
      {"crs", "two.txt", R"(PROJCRS["a",BASEGEOGCRS["b",ID["EPSG",4258]],ID["EPSG",25832]])"},
      {"zones_geojson", "polygon.json", R"({"type":"Polygon","coordinates":[[[0,0],[9,0],[9,999]],[[2,1],[3,1],[3,2]]]})"},
      {"zones_geojson", "features.json",
       R"({"type":"FeatureCollection","crs":{"properties":{"name":"EPSG:25832"}},"features":[{"type":"Feature","geometry":)"
       R"({"type":"MultiPolygon","coordinates":[[[[0,0],[9,0],[9,9]]]]}}]})"},
      {"zones_csv", "corners.csv", "0,0\n9,0\n9,9\n\n1 1\n2 1\n2 2\n"},
      {"zones_csv", "named.csv", "# zone\nid;x;y\na;0;0\na;9;0\na;9;9\n"},
      {"toml", "a.toml", "[scene]\nname = \"pipes:cylinders=12\"\nstart = [0.0, 0.0, 1.5]\n[surface]\neta = 0.05 # [m]\n[explore]\nfill = true\n"}};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  try {
    std::vector<Seed> seeds = other_seeds();
    for (const auto& more : {city_seeds(), triangle_seeds()}) seeds.insert(seeds.end(), more.begin(), more.end());
    for (const auto& files : {samples::all(), samples::scenes()})
      for (const auto& [name, bytes] : files)
        if (const std::string reader = name.substr(name.rfind('.') + 1); reader != "json" && reader != "gltf" && reader != "glb")
          seeds.push_back({reader, name, bytes});
    for (const Seed& seed : seeds) {
      const std::filesystem::path folder = std::filesystem::path(arguments[1]) / seed.reader;
      std::filesystem::create_directories(folder);
      write_file(folder / seed.name, seed.bytes);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "fuzz_seeds: {}\n", error.what());
    return 1;
  }
  return 0;
}
