// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/patch_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"
#include "vantage/io/glb.h"
#include "vantage/io/mesh_file.h"
#include "vantage/io/obj.h"

namespace vantage {
namespace {

/// A polygon (where there is one), a segment and a point, far from the origin.
template <int Dim>
std::vector<Patch<Dim>> some_patches();

template <>
std::vector<Patch<2>> some_patches<2>() {
  std::vector<Patch<2>> patches{segment_patch<2>({6e6 + 0.125, 1}, {6e6 + 1, 2}), point_patch<2>({3, 4})};
  patches[0].data_to_surface = 0.01F;
  patches[0].surface_to_data = 0.02F;
  return patches;
}

template <>
std::vector<Patch<3>> some_patches<3>() {
  Patch<3> polygon;
  polygon.count = 4;
  polygon.vertices = {Vec<3>(6e6 + 0.125, 0, 1), Vec<3>(6e6 + 1, 0, 1), Vec<3>(6e6 + 1, 1, 1), Vec<3>(6e6, 1, 1)};
  polygon.data_to_surface = 0.03F;
  polygon.surface_to_data = 0.04F;
  std::vector<Patch<3>> patches{polygon, segment_patch<3>({1, 2, 3}, {4, 5, 6}), point_patch<3>({7, 8, 9})};
  patches[2].data_to_surface = 0.05F;
  return patches;
}

template <class Dimension>
class PatchFiles : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PatchFiles, Dimensions);

TYPED_TEST(PatchFiles, ReadBackExactly) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Patch<Dim>> patches = some_patches<Dim>();
  const auto read = std::get<std::vector<Patch<Dim>>>(parse_patches(patches_as_ply<Dim>(patches), "a.ply"));
  ASSERT_EQ(read.size(), patches.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    ASSERT_EQ(read[i].count, patches[i].count);
    for (std::size_t k = 0; k < read[i].corners().size(); ++k) EXPECT_EQ(read[i].corners()[k], patches[i].corners()[k]);
    EXPECT_EQ(read[i].data_to_surface, patches[i].data_to_surface);
    EXPECT_EQ(read[i].surface_to_data, patches[i].surface_to_data);
  }
}

TYPED_TEST(PatchFiles, GlbIsWellFormed) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Vec<Dim>> path{Vec<Dim>::Zero(), Vec<Dim>::Ones()};
  const std::string glb = surface_as_glb<Dim>(some_patches<Dim>(), path);
  ASSERT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(get<std::uint32_t>(glb, 8), glb.size());
  const std::size_t length = get<std::uint32_t>(glb, 12);
  ASSERT_EQ(length % 4, 0U);
  const auto json = nlohmann::json::parse(glb.substr(20, length));
  const std::size_t binary = get<std::uint32_t>(glb, 20 + length);
  EXPECT_EQ(json["buffers"][0]["byteLength"], binary);
  EXPECT_EQ(glb.substr(24 + length, 4), std::string("BIN\0", 4));
  for (const auto& view : json["bufferViews"]) EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), binary);
  std::map<int, int> vertices;  // By mode: points, lines, line strip, triangles.
  for (const auto& primitive : json["meshes"][0]["primitives"]) {
    const auto& accessor = json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    vertices[primitive["mode"].get<int>()] = accessor["count"].get<int>();
  }
  EXPECT_EQ(vertices, (Dim == 3 ? std::map<int, int>{{0, 1}, {1, 2}, {3, 2}, {4, 6}} : std::map<int, int>{{0, 1}, {1, 2}, {3, 2}}));
}

TYPED_TEST(PatchFiles, ObjHasEveryCorner) {
  constexpr int Dim = TypeParam::value;
  const std::string obj = patches_as_obj<Dim>(some_patches<Dim>());
  EXPECT_EQ(obj, Dim == 3 ? "# vantage: metres, z up\nv 6000000.125 0 1\nv 6000001 0 1\nv 6000001 1 1\nv 6000000 1 1\nv 1 2 3\nv 4 5 6\nv 7 8 9\n"
                            "f 1 2 3 4\nl 5 6\np 7\n"
                          : "# vantage: metres, z up\nv 6000000.125 1 0\nv 6000001 2 0\nv 3 4 0\nl 1 2\np 3\n");
}

/// The reader of meshes finds the triangles of the polygons where they are.
TEST(PatchFile, MeshReadersFindThePolygonsInPlace) {
  const std::filesystem::path folder = testing::TempDir();
  const std::vector<Patch<3>> patches = some_patches<3>();
  const std::pair<std::string, std::string> files[] = {{"patches_test.obj", patches_as_obj<3>(patches)},
                                                       {"patches_test.glb", surface_as_glb<3>(std::span(patches).first(1), {})}};
  for (const auto& [name, bytes] : files) {
    const std::filesystem::path path = folder / name;
    write_file(path, bytes);
    const Mesh<3> mesh = read_mesh(path);
    EXPECT_EQ(mesh.facets.size(), 2U) << name;
    // A reader that multiplies by the node's transform in floats is off by their steps at 6000 km.
    const double tolerance = name.ends_with(".obj") ? 0.0 : 0.51;
    EXPECT_LE((mesh.bounds().low - Vec<3>(6e6, 0, 1)).cwiseAbs().maxCoeff(), tolerance) << name;
    EXPECT_LE((mesh.bounds().high - Vec<3>(6e6 + 1, 1, 1)).cwiseAbs().maxCoeff(), tolerance) << name;
    std::filesystem::remove(path);
  }
}

TYPED_TEST(PatchFiles, NothingIsAlsoAFile) {
  constexpr int Dim = TypeParam::value;
  EXPECT_EQ(patches_as_obj<Dim>({}), "# vantage: metres, z up\n");
  EXPECT_TRUE(std::get<std::vector<Patch<Dim>>>(parse_patches(patches_as_ply<Dim>({}), "a.ply")).empty());
  EXPECT_EQ(surface_as_glb<Dim>({}, {}).substr(0, 4), "glTF");
}

TEST(PatchFile, RefusesWhatIsNoPatch) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  const std::pair<std::string, std::string> table[] = {
      {head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "vertex 3 of 3"},
      {head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "vertex -1 of 3"},
      {head + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "2 corners"},
      {head + "0 0 0\n1 0 0\n0 1 0\n9 0 1 2 0 1 2 0 1 2\n", "9 corners"},
      {head + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n", "vertex 1: coordinates must be finite"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement point 1\nproperty int "
       "vertex\nend_header\n0 0 0\n1\n",
       "point 0: vertex 1 of 1"},
      {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nend_header\n", "without z"},
  };
  for (const auto& [bytes, message] : table) {
    try {
      static_cast<void>(parse_patches(bytes, "a.ply"));
      ADD_FAILURE() << "accepted: " << message;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace vantage
