// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <optional>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/sample_scenes.h"
#include "vantage/io/test_data.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// The error as "CODE message"; checks that it is one line of printable text. Empty: none.
std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    const std::string message = e.what();
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
    return std::to_string(static_cast<int>(e.code())) + " " + message;
  }
  return {};
}

Mesh<3> tetrahedron(double shift = 0.0) {
  Mesh<3> mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 1.0 / 3.0}};
  for (Vec<3>& v : mesh.vertices) v.array() += shift;
  mesh.facets = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

double area(const Mesh<3>& mesh) {
  double sum = 0.0;
  for (const auto& f : mesh.facets) sum += 0.5 * (mesh.vertices[f[1]] - mesh.vertices[f[0]]).cross(mesh.vertices[f[2]] - mesh.vertices[f[0]]).norm();
  return sum;
}

/// Mesh of a file that holds `text`.
Mesh<3> read_text(const std::string& name, const std::string& text, const MeshFileOptions& options = {}) {
  static const ScratchFolder folder;
  std::filesystem::remove(folder / name);  // Writing over a file would wait for the disk.
  std::ofstream(folder / name, std::ios::binary) << text;
  return read_mesh(folder / name, options);
}

void expect_size(const Mesh<3>& mesh, const Vec<3>& size, double tolerance) {
  EXPECT_LT((mesh.bounds().size() - size).cwiseAbs().maxCoeff(), tolerance) << mesh.bounds().size().transpose();
}

TEST(MeshFile, ComesBackAsWritten) {
  const ScratchFolder folder;
  for (const double shift : {0.0, 1e6}) {
    const Mesh<3> mesh = tetrahedron(shift);
    for (const char* name : {"a.ply", "a.obj", "a.stl"}) {
      write_mesh(folder / name, mesh);
      const Mesh<3> back = read_mesh(folder / name);
      const bool rounded = std::string(name) == "a.stl";  // Floats.
      ASSERT_EQ(back.facets.size(), 4U);
      ASSERT_EQ(back.vertices.size(), 4U);
      for (std::size_t f = 0; f < 4; ++f)
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_LE((back.vertices[back.facets[f][k]] - mesh.vertices[mesh.facets[f][k]]).norm(), rounded ? 1e-7 * (1.0 + shift) : 0.0) << name;
    }
  }
  EXPECT_THAT(error_of([&] { write_mesh(folder / "a.xyz", tetrahedron()); }), HasSubstr("must end in .ply, .obj or .stl"));
}

TEST(MeshFile, PlaneMeshesAreWrittenAsEdges) {
  const ScratchFolder folder;
  Mesh<2> mesh;
  mesh.vertices = {{0, 0}, {2, 1}};
  mesh.facets = {{0, 1}};
  write_mesh(folder / "a.obj", mesh);
  EXPECT_EQ(read_file(folder / "a.obj"), "v 0 0 0\nv 2 1 0\nl 1 2\n");
  write_mesh(folder / "a.ply", mesh);
  EXPECT_THAT(read_file(folder / "a.ply"), HasSubstr("element edge 1"));
  EXPECT_THAT(error_of([&] { write_mesh(folder / "a.stl", mesh); }), HasSubstr("STL holds triangles only"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.stl"));
}

TEST(MeshFile, UpAxisAndUnit) {
  const std::string obj = "v 1 2 3\nv 4 2 3\nv 1 7 3\nf 1 2 3\n";
  EXPECT_EQ(read_text("a.obj", obj).vertices[2], Vec<3>(1, 7, 3));
  MeshFileOptions options;
  options.up = MeshFileOptions::Up::y;
  options.unit = 0.5;
  EXPECT_EQ(read_text("a.obj", obj, options).vertices[2], Vec<3>(0.5, -1.5, 3.5));
  options.unit = -1.0;
  EXPECT_THAT(error_of([&] { (void)read_text("a.obj", obj, options); }), HasSubstr("unit = -1: must be > 0"));
}

TEST(MeshFile, ObjFinePoints) {
  const Mesh<3> mesh =
      read_text("a.OBJ", "# c\r\nv 0 0 0\r\nv 1. 0 0 # x\r\nv +1 1 0\r\nv 0 1 0\r\nvn 0 0 1\r\nf 1//1 2//1 \\\r\n 3//1\r\nf -4/1/1 -2 -1\r\n");
  EXPECT_EQ(mesh.facets, (std::vector<Mesh<3>::Facet>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.vertices.size(), 4U);
}

TEST(MeshFile, PolygonsAreCutWithinTheirOutline) {
  // An arrowhead and an L, whose fans would leave the outline, and a square: area tells.
  EXPECT_DOUBLE_EQ(area(read_text("a.obj", "v 0 0 5\nv 2 1 5\nv 0 2 5\nv 1 1 5\nf 1 2 3 4\n")), 1.0);
  EXPECT_DOUBLE_EQ(area(read_text("a.obj", "v 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4 5 6\n")), 3.0);
  EXPECT_DOUBLE_EQ(area(read_text("a.obj", "v 0 0 0\nv 0 0 1\nv 0 1 1\nv 0 1 0\nf 4 3 2 1\n")), 1.0);
}

TEST(MeshFile, PlyOfEveryKind) {
  const std::string head =
      "ply\nformat {} 1.0\nelement vertex 3\nproperty uchar red\nproperty float x\nproperty double y\nproperty short z\nelement face 1\n"
      "property list uchar uint vertex_index\nend_header\n";
  const auto with = [&](const std::string& format) { return std::string(head).replace(head.find("{}"), 2, format); };
  const std::vector<Vec<3>> truth{{0, 0, 7}, {1.5, 0, 7}, {0, 2.5, -7}};
  EXPECT_EQ(read_text("a.ply", with("ascii") + "255 0 0 7\n1 1.5 0 7 9 0 2.5 -7\n3 0 1 2\n").vertices, truth);
  for (const bool big : {false, true}) {
    std::string body;
    const auto put = [&](auto value) {
      std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
      if (big) std::reverse(raw.begin(), raw.end());
      body += raw;
    };
    for (const Vec<3>& v : truth) put(std::uint8_t{1}), put(static_cast<float>(v[0])), put(v[1]), put(static_cast<std::int16_t>(v[2]));
    put(std::uint8_t{3});
    for (const std::uint32_t i : {0U, 1U, 2U}) put(i);
    const std::string bytes = with(big ? "binary_big_endian" : "binary_little_endian") + body;
    EXPECT_EQ(read_text("a.ply", bytes).vertices, truth);
    for (std::size_t n = 0; n < bytes.size(); ++n)
      EXPECT_THAT(error_of([&] { (void)read_text("a.ply", bytes.substr(0, n)); }), testing::StartsWith("2 ")) << n;
  }
}

TEST(MeshFile, ColladaUnitsAxesAndNodes) {
  const auto dae = [](const std::string& asset) {
    return "<COLLADA><asset>" + asset +
           R"(</asset><library_geometries><geometry id="g"><mesh><source id="s"><float_array id="f" count="9">0 0 0 1 0 0 0 0 2</float_array>
      <technique_common><accessor source="#f" count="3" stride="3"/></technique_common></source><vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
      <triangles count="1"><input semantic="NORMAL" source="#n" offset="0"/><input semantic="VERTEX" source="#v" offset="1"/><p>9 0 9 1 9 2</p></triangles></mesh></geometry></library_geometries>
      <library_nodes><node id="n"><scale>2 2 2</scale><instance_geometry url="#g"/></node></library_nodes><library_visual_scenes><visual_scene id="w">
      <node><translate>10 0 0</translate><rotate>0 0 1 90</rotate><instance_node url="#n"/></node></visual_scene></library_visual_scenes>
      <scene><instance_visual_scene url="#w"/></scene></COLLADA>)";
  };
  // Scaled by 2, turned about z (x becomes y), moved by 10: corners (10 0 0) (10 2 0) (10 0 4).
  const auto corner = [&](const std::string& asset, std::size_t i) { return read_text("a.dae", dae(asset)).vertices[i]; };
  EXPECT_LT((corner("<up_axis>Z_UP</up_axis>", 1) - Vec<3>(10, 2, 0)).norm(), 1e-12);
  EXPECT_LT((corner(R"(<unit meter="0.0254" name="inch"/><up_axis>Z_UP</up_axis>)", 2) - 0.0254 * Vec<3>(10, 0, 4)).norm(), 1e-12);
  EXPECT_LT((corner(R"(<unit name="inch" meter="0.0254"/>)", 1) - 0.0254 * Vec<3>(10, 0, 2)).norm(), 1e-12);  // Y up unless said.
  EXPECT_LT((corner("<up_axis>X_UP</up_axis>", 2) - Vec<3>(0, -4, 10)).norm(), 1e-12);
  EXPECT_THAT(error_of([&] { (void)corner(R"(<unit meter="0"/>)", 0); }), HasSubstr("<unit meter=\"0\">: must be > 0"));
  std::string cycle = dae("");
  cycle.replace(cycle.find("<instance_geometry"), 0, "<instance_node url=\"#n\"/>");
  EXPECT_THAT(error_of([&] { (void)read_text("a.dae", cycle); }), HasSubstr("nodes contain themselves"));
}

const std::string kGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[1,2,3]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
    R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}],)"
    R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0]}]})";

TEST(MeshFile, GltfIsYUp) {
  const Mesh<3> mesh = read_text("a.gltf", kGltf);  // (0 0 0) (1 0 0) (0 2 0), moved, turned upright.
  ASSERT_EQ(mesh.vertices.size(), 3U);
  EXPECT_EQ(mesh.vertices[0], Vec<3>(1, -3, 2));
  EXPECT_EQ(mesh.vertices[2], Vec<3>(1, -3, 4));
  MeshFileOptions options;
  options.up = MeshFileOptions::Up::z;
  EXPECT_EQ(read_text("a.gltf", kGltf, options).vertices[0], Vec<3>(1, 2, 3));
}

TEST(MeshFile, HostileGltf) {
  const auto replaced = [](const std::string& what, const std::string& by) { return std::string(kGltf).replace(kGltf.find(what), what.size(), by); };
  const auto error = [&](const std::string& text) { return error_of([&] { (void)read_text("a.gltf", text); }); };
  EXPECT_THAT(error(replaced("\"count\":3", "\"count\":3000000000")), HasSubstr("accessors[0]: 3000000000 elements exceed bufferViews[0]"));
  EXPECT_THAT(error(replaced("\"mesh\":0,\"translation\"", "\"mesh\":0,\"children\":[0],\"translation\"")), HasSubstr("nodes contain themselves"));
  EXPECT_THAT(error(replaced("\"byteLength\":36,\"uri\"", "\"byteLength\":36,\"url\"")), testing::StartsWith("2 "));
  EXPECT_THAT(error("{}"), HasSubstr("lacks 'asset'"));
  EXPECT_THAT(error("glTFglTFglTFglTFglTFglTF"), HasSubstr("GLB header"));
  EXPECT_THAT(error("[1"), testing::StartsWith("2 "));
}

struct HostileCase {
  const char* name;
  const char* text;
  const char* error;
};

TEST(MeshFile, GltfStripsFansSparseOnesAndNodes) {
  const Mesh<3> mesh = read_text("a.gltf", samples::gltf()), same = read_text("a.glb", samples::glb());
  EXPECT_EQ(mesh.vertices, same.vertices);
  EXPECT_EQ(mesh.facets, same.facets);
  ASSERT_EQ(mesh.facets.size(), 8U);
  const auto corners = [&](std::size_t facet) {
    std::vector<Vec<3>> places;
    for (const std::uint32_t v : mesh.facets[facet]) places.emplace_back(mesh.vertices[v][0], mesh.vertices[v][2], -mesh.vertices[v][1]);  // y up.
    return places;
  };
  using Places = std::vector<Vec<3>>;
  EXPECT_EQ(corners(0), (Places{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));    // The strip 1 2 3 4, its indices begin at byte 2;
  EXPECT_EQ(corners(1), (Places{{1, 1, 0}, {0, 1, 0}, {0, 0, 1}}));    // both triangles turn the same way.
  EXPECT_EQ(corners(2), (Places{{-1, 2, 3}, {1, 0, 3}, {-1, 0, 3}}));  // Half a turn about z, twice as large, moved.
  EXPECT_EQ(corners(4), (Places{{6, 0, 1}, {6, 0, 0}, {5, 1, 0}}));    // The fan 0 1 2 3, whose vertex 0 is another one, moved by a matrix.
  EXPECT_EQ(corners(5), (Places{{6, 0, 1}, {5, 1, 0}, {6, 1, 0}}));
  EXPECT_EQ(corners(7), (Places{{6, 1, 0}, {5, 0, 1}, {6, 0, 1}}));  // Without indices: 3 4 5.
}

TEST(MeshFile, HostileGltfParts) {
  const auto error = [](const std::string& what, const std::string& by) {
    return error_of([&] { (void)read_text("a.gltf", replaced(samples::gltf(), what, by)); });
  };
  const HostileCase cases[] = {
      {"\"2.0\"", "\"1.0\"", "glTF 1.0: only 2.0 is read"},
      {"\"count\":6,", "\"count\":7,", "accessors[0]: 7 elements exceed bufferViews[0]"},
      {"\"byteOffset\":2", "\"byteOffset\":1e14", "accessors[1]: 4 elements exceed bufferViews[1]"},
      {"\"byteOffset\":2", "\"byteOffset\":-2", "accessors[1].byteOffset = -2: must be a whole number"},
      {"\"byteStride\":12", "\"byteStride\":0", "bufferViews[0].byteStride = 0: must be at least 12"},
      {"\"byteLength\":84", "\"byteLength\":85", "buffers[0]: 85 bytes exceed the 84 that are there"},
      {"\"byteOffset\":72", "\"byteOffset\":73", "bufferViews[1]: 12 bytes from 73 exceed its buffer"},
      {"\"componentType\":5126", "\"componentType\":5124", "componentType = 5124"},
      {"\"type\":\"VEC3\"", "\"type\":\"VEC2\"", "accessors[0].type: must be VEC3"},
      {"\"mode\":6", "\"mode\":\"6\"", "meshes[1]"},
      {"base64,AAAA", "base64,AA*A", "buffers[0].uri: must be base64"},
      {"\"data:", "\"http:", "no such file beside it"},
      {"\"nodes\":[0]", "\"nodes\":[7]", "nodes[7] is not there: 3 are"},
      {"\"children\":[1,2]", "\"children\":[1,1]", "nodes[1] has two parents"},
      {"\"rotation\":[0,0,1,0]", "\"rotation\":[0,0,1]", "nodes[1].rotation: must be 4 numbers"},
      {"\"scale\":[2,2,2]", "\"scale\":[2,2,1e999]", "a.gltf"},
      {"\"asset\":{\"version\":\"2.0\"}", "\"asset\":[]", "lacks 'version'"},
      {"{\"asset\"", "{\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\"", "KHR_draco_mesh_compression: is not read"},
  };
  for (const HostileCase& c : cases) EXPECT_THAT(error(c.name, c.text), HasSubstr(c.error)) << c.name;
  const std::string glb = samples::glb();
  for (std::size_t n = 0; n < glb.size(); ++n)
    EXPECT_THAT(error_of([&] { (void)read_text("a.glb", glb.substr(0, n)); }), testing::StartsWith("2 ")) << n;
}

TEST(MeshFile, HostileText) {
  const HostileCase cases[] = {
      {"a.obj", "", "is empty"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv nan 0 0\nf 1 2 3\n", "vertex 2 is not finite"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 1e999 0 0\nf 1 2 3\n", "vertex 2 is not finite"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 1 0\nf 1 2 3\n", "line 3: needs three numbers"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n", "face 0 names vertex 3: must be 0 .. 2"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 -4\n", "face 0 names vertex -1"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\n", "holds no triangles (3 vertices, 0 faces)"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 x 3\n", "line 4: face corner 'x': must be a vertex"},
      {"a.ply", "PLX\n", "not a PLY file"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 4294967295\nproperty float x\nend_header\n0 0 0\n",
       "4294967295 vertex elements exceed the file"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "element vertex: count -1: must be a whole number"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n", "lack x, y or z"},
      {"a.ply", "ply\nformat ascii 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n4294967295 0\n",
       "list length 4294967295 exceeds the file"},
      {"a.ply", "ply\nformat ascii 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\nnan 0\n",
       "list length nan exceeds the file"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 zero 0\n",
       "not a number"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "OFF header: 3 vertices"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "face 0: needs 3 corners"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n900 0 1 2\n", "face 0: cut short"},
      {"a.stl", "solid x\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n", "cut short"},
      {"a.stl", "solid x\nfacet\nouter loop\nvertex 0 0\n", "vertex 0: needs three numbers"},
      {"a.stl", "binary", "not an STL file"},
      {"a.dae", "<COLLADA><asset>", "not well-formed XML"},
      {"a.dae", "<html/>", "not a COLLADA file"},
      {"a.dae", "<COLLADA/>", "has no <visual_scene>"},
      {"a.xyz", "0 0 0\n", "its name must end in .obj, .ply, .stl, .off, .dae, .gltf, .glb"},
  };
  for (const HostileCase& c : cases) {
    const std::string error = error_of([&] { (void)read_text(c.name, c.text); });
    EXPECT_THAT(error, testing::StartsWith("2 ")) << c.text;
    EXPECT_THAT(error, HasSubstr(c.error));
    EXPECT_THAT(error, HasSubstr(c.name));
  }
  EXPECT_THAT(error_of([] { (void)read_mesh("/no/such/file.ply"); }), "3 /no/such/file.ply: cannot open: No such file or directory");
  EXPECT_THAT(error_of([] { (void)read_mesh("/"); }), HasSubstr("is a folder"));
}

TEST(MeshFile, TruncatedBinaryStl) {
  const ScratchFolder folder;
  write_mesh(folder / "a.stl", tetrahedron());
  const std::string bytes = read_file(folder / "a.stl");
  EXPECT_THAT(error_of([&] { (void)read_text("a.stl", bytes.substr(0, 200)); }), HasSubstr("4 triangles need 284 bytes, the file has 200"));
  EXPECT_EQ(read_text("a.stl", std::string("solid") + bytes.substr(5)).facets.size(), 4U);  // Binary, whatever its comment says.
}

TEST(MeshFile, DamagedFilesEndInAnErrorOrAMesh) {
  const ScratchFolder folder;
  const Mesh<3> mesh = tetrahedron();
  write_mesh(folder / "a.ply", mesh);
  write_mesh(folder / "a.obj", mesh);
  write_mesh(folder / "a.stl", mesh);
  write_file(folder / "a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n");
  Random random(8);
  int broken = 0;
  for (const std::string name : {"a.ply", "a.obj", "a.stl", "a.off"}) {
    const std::string whole = read_file(folder / name);
    for (int i = 0; i < 300; ++i) {
      std::string bytes = whole.substr(0, i % 3 == 0 ? random.below(whole.size()) : whole.size());
      for (int k = 0; k < 4 && !bytes.empty(); ++k) bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
      broken += error_of([&] { EXPECT_GT(read_text(name, bytes).facets.size(), 0U); }).empty() ? 0 : 1;
    }
  }
  EXPECT_GT(broken, 300);
}

/// Of every malformed file upstream keeps: the triangles it gives, or what the error says.
struct KnownFile {
  const char* path;
  std::optional<std::size_t> triangles;
  const char* error = "";
};

TEST(MeshFile, MalformedFilesOfOtherProjects) {
  VANTAGE_NEEDS_DATA("corrupt");
  const KnownFile files[] = {
      {"assimp/OutOfMemory.off", {}, "353535235358 vertices and 6 faces are more than the file's 309 bytes can hold"},
      {"assimp/badArray.gltf", {}, "meshes[0].primitives: must be an array"},
      {"assimp/badUint.gltf", {}, "BoxTextured0.bin"},
      {"assimp/box_longline.obj", 944},
      {"assimp/box_nested_animation_4286.dae", 12},  // The count that is too small is not needed.
      {"assimp/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", {}, ": not known"},
      {"assimp/cube_binary_starts_with_nl.ply", 12},
      {"assimp/empty.obj", {}, "is empty"},
      {"assimp/empty.ply", {}, "is empty"},
      {"assimp/malformed.obj", {}, "line 28: face corner '0': must be a vertex, 1 .. 8"},
      {"assimp/number_formats.obj", 1},
      {"assimp/triangle_with_empty_solid.stl", 1},
      {"assimp/readme.txt", {}, "not a mesh file"},
      {"pdal/issue_2421.ply", {}, "holds no triangles (1 vertices, 0 faces)"},
      {"pdal/mesh.ply", 2},
      {"pdal/no_vertex.obj", {}, "holds no triangles (0 vertices, 0 faces)"},
      {"pdal/no_vertex.ply", {}, "holds no triangles (0 vertices, 0 faces)"},
      {"pdal/badheader.txt", {}, "not a mesh file"},
      {"trimesh/busted.STL", 3878},
      {"trimesh/points_emptyface.ply", {}, "holds no triangles (1024 vertices, 0 faces)"},
  };
  for (const KnownFile& file : files) {
    std::optional<std::size_t> triangles;
    const std::string error = error_of([&] { triangles = read_mesh(data_set("corrupt") / file.path).facets.size(); });
    EXPECT_EQ(triangles, file.triangles) << file.path << ": " << error;
    EXPECT_THAT(error, HasSubstr(file.error));
    EXPECT_EQ(error.substr(0, 2), file.triangles ? "" : "2 ");
  }
}

TEST(MeshFile, TownModelsHaveTheirTrueSize) {
  VANTAGE_NEEDS_DATA("simple_city");
  const std::filesystem::path folder = data_set("simple_city");
  struct Model {
    const char* name;
    std::size_t triangles;
    Vec<3> size;
  };
  const Model models[] = {{"house_1", 1884, {11.0, 8.6, 5.1}},       {"house_3", 1632, {8.8, 5.8, 6.1}},
                          {"school", 5128, {33.0, 17.5, 14.2}},      {"gas_station", 4940, {20.6, 30.0, 9.0}},
                          {"radio_tower", 4892, {11.7, 13.4, 44.2}}, {"telephone_pole", 226, {2.1, 0.24, 9.2}},
                          {"lamp_post", 270, {0.16, 1.06, 3.09}},    {"powerplant", 4693, {99.1, 64.7, 48.0}}};
  for (const Model& model : models) {
    const Mesh<3> mesh = read_mesh(folder / "original" / (std::string(model.name) + ".dae"));
    EXPECT_EQ(mesh.facets.size(), model.triangles) << model.name;
    expect_size(mesh, model.size, 0.06);
    EXPECT_NEAR(mesh.bounds().low[2], 0.0, 0.01) << model.name;  // They stand on the ground: z is up.
  }
  MeshFileOptions inches;
  inches.unit = 0.0254;
  expect_size(read_mesh(folder / "original/cloverleaf.obj", inches), {355.6, 355.9, 6.7}, 0.1);
  EXPECT_EQ(read_mesh(folder / "ground_quad_ADDED.obj").facets.size(), 2U);
}

TEST(MeshFile, Levine) {
  VANTAGE_NEEDS_DATA("levine_stl");
  const Mesh<3> mesh = read_mesh(data_set("levine_stl") / "levine.stl");
  EXPECT_EQ(mesh.facets.size(), 610U);
  expect_size(mesh, {15.1, 27.6, 2.5}, 0.05);
}

}  // namespace
}  // namespace vantage
