// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "vantage/base/error.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/io/mesh_file.h"
#include "vantage/io/test_data.h"
#include "vantage/world/find_start.h"
#include "vantage/world/inside_solid.h"
#include "vantage/world/lidar.h"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    return std::to_string(static_cast<int>(e.code())) + " " + e.what();
  }
  return {};
}

void add_box(Mesh<3>& mesh, const Vec<3>& low, const Vec<3>& high) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back({(i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]});
  for (const auto& f : std::vector<std::array<std::uint32_t, 3>>{
           {0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}})
    mesh.facets.push_back({n + f[0], n + f[1], n + f[2]});
}

void add_ground(Mesh<3>& mesh, double half, double z) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
  mesh.facets.push_back({n, n + 1, n + 2});
  mesh.facets.push_back({n, n + 2, n + 3});
}

/// Every way in which a scene's start may be bad.
template <int Dim>
void expect_good_start(const Scene<Dim>& scene) {
  const RayCaster<Dim> world(scene.mesh);
  EXPECT_TRUE(scene.domain.contains(scene.start)) << scene.start.transpose();
  EXPECT_GE(world.distance(scene.start), scene.clearance);
  EXPECT_FALSE(inside_solid<Dim>(world, scene.start));
}

TEST(NiceNumber, IsNearestInRatio) {
  EXPECT_EQ(nice_number(1.65), 1.5);
  EXPECT_EQ(nice_number(0.138), 0.15);
  EXPECT_EQ(nice_number(0.1008), 0.1);
  EXPECT_EQ(nice_number(9.5), 10.0);
  EXPECT_EQ(nice_number(7000.0), 8000.0);
  for (const double x : {1e-6, 0.02, 0.5, 3.0, 800.0}) EXPECT_DOUBLE_EQ(nice_number(x), x);
}

TEST(FindStart, StandsInTheStreetNotInTheHouses) {
  Mesh<3> mesh;
  add_ground(mesh, 60.0, 4.0);
  for (const double x : {-30.0, 0.0, 30.0})
    for (const double y : {-30.0, 0.0, 30.0})
      add_box(mesh, {x - 10.0, y - 10.0, 3.0}, {x + 10.0, y + 10.0, 12.0});  // Houses sunk 1 m into the ground.
  const RayCaster<3> world(mesh);
  EXPECT_EQ(ground_level(world, mesh.bounds()), 4.0);
  Box<3> domain = mesh.bounds();
  domain.low[2] = 4.0;
  const Vec<3> start = find_start(world, domain, {1.0, 80.0});
  EXPECT_DOUBLE_EQ(start[2], 5.7);
  EXPECT_FALSE(inside_solid<3>(world, start));
  EXPECT_GE(world.distance(start), 1.0);
  EXPECT_LT(start.head<2>().cwiseAbs().maxCoeff(), 40.0);  // Among them, not in the field outside.
}

TEST(FindStart, FloatsWhereThereIsNoGround) {
  Mesh<3> mesh;
  add_box(mesh, {-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  const RayCaster<3> world(mesh);
  const Box<3> domain = mesh.bounds().grown(2.0);
  const Vec<3> start = find_start(world, domain, {0.1, 80.0});
  EXPECT_TRUE(domain.contains(start));
  EXPECT_FALSE(inside_solid<3>(world, start));
  EXPECT_EQ(ground_level(RayCaster<3>(Mesh<3>{}), domain), domain.low[2]);
}

TEST(SceneFile, JoinsFilesAndFurnishes) {
  const ScratchFolder folder;
  Mesh<3> houses, ground;
  add_box(houses, {-10.0, -10.0, 0.0}, {-2.0, 10.0, 6.0});
  add_box(houses, {2.0, -10.0, 0.0}, {10.0, 10.0, 6.0});
  add_ground(ground, 20.0, 0.0);
  write_mesh(folder / "houses.ply", houses);
  write_mesh(folder / "ground.obj", ground);
  const auto scene = std::get<Scene<3>>(load_scene_file((folder / "houses.ply").string() + "+" + (folder / "ground.obj").string()));
  EXPECT_EQ(scene.name, "houses");
  EXPECT_EQ(scene.mesh.facets.size(), 26U);
  ASSERT_EQ(scene.parts.size(), 2U);
  EXPECT_EQ(scene.parts[1].name, "ground");
  EXPECT_EQ(scene.parts[1].first, 24U);
  EXPECT_EQ(scene.parts[1].count, 2U);
  EXPECT_EQ(scene.domain.low, Vec<3>(-20, -20, 0));
  EXPECT_EQ(scene.domain.high, Vec<3>(20, 20, 8));
  EXPECT_EQ(scene.voxel, 0.2);
  EXPECT_DOUBLE_EQ(scene.eta, 0.04);
  expect_good_start(scene);
  SceneFileOptions feet;
  feet.unit = 0.3048;
  EXPECT_NEAR(std::get<Scene<3>>(load_scene_file(folder / "ground.obj", feet)).domain.size()[0], 12.192, 1e-9);
  feet.up = SceneFileOptions::Up::y;
  EXPECT_NEAR(std::get<Scene<3>>(load_scene_file(folder / "houses.ply", feet)).mesh.bounds().size()[2], 6.096, 1e-9);
  // A plus within a file's own name.
  write_mesh(folder / "a+b.ply", ground);
  EXPECT_EQ(std::get<Scene<3>>(load_scene_file(folder / "a+b.ply")).name, "a+b");
}

TEST(SceneFile, SaysWhatItCannotRead) {
  const ScratchFolder folder;
  EXPECT_THAT(error_of([&] { (void)load_scene_file(folder / "none.ply"); }),
              testing::AllOf(testing::StartsWith("3 "), HasSubstr("none.ply: cannot open")));
  EXPECT_THAT(error_of([&] { (void)load_scene_file(folder / "none.yaml"); }), testing::StartsWith("3 "));
  EXPECT_THAT(error_of([&] { (void)load_scene_file("a.png+b.ply"); }), HasSubstr("a.png: not a scene file: its name must end in .obj, .ply"));
  EXPECT_THAT(error_of([&] { (void)load_scene_file("town.las"); }), testing::StartsWith("2 town.las: not a scene file"));
  EXPECT_THAT(error_of([&] { (void)load_scene_file(""); }), testing::StartsWith("2 "));
  std::ofstream(folder / "dot.obj") << "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n";
  EXPECT_THAT(error_of([&] { (void)load_scene_file(folder / "dot.obj"); }), HasSubstr("the mesh spans 0 m"));
  std::ofstream(folder / "black.pgm") << "P2 2 1 255\n0 0\n";
  EXPECT_THAT(error_of([&] { (void)load_scene_file(folder / "black.pgm"); }), HasSubstr("black.pgm: map without a free cell"));
}

TEST(SceneFile, PlanStartsInItsWidestPlace) {
  const ScratchFolder folder;
  // A closet that is wider than the corridor, but cut off; and a hall.
  const std::vector<std::string> rows{"##################", "#....#...........#", "#....#...........#", "#....#.....#######",
                                      "#....#.....#######", "######.....#######", "##################"};
  std::ofstream file(folder / "plan.pgm");
  file << "P2 18 7 255\n";
  for (const std::string& row : rows)
    for (const char c : row) file << (c == '.' ? "254 " : "0 ");
  file.close();
  SceneFileOptions meters;
  meters.unit = 1.0;
  const auto scene = std::get<Scene<2>>(load_scene_file(folder / "plan.pgm", meters));
  EXPECT_EQ(scene.start, Vec<2>(8.5, 3.5));
  EXPECT_EQ(scene.voxel, 2.0);
  EXPECT_EQ(scene.domain.low, Vec<2>(-1, -1));
  EXPECT_EQ(scene.domain.high, Vec<2>(19, 8));
  EXPECT_EQ(scene.parts[1].name, "frame");
}

TEST(SceneFile, RealPlansCloseAroundTheirStart) {
  VANTAGE_NEEDS_DATA("maps2d");
  for (const char* name : {"stata_basement.yaml", "levinelobby.yaml", "stata_basement.png", "levinelobby.pgm"}) {
    const auto scene = std::get<Scene<2>>(load_scene_file(data_set("maps2d") / name));
    expect_good_start(scene);
    EXPECT_EQ(scene.voxel, 0.1);
    EXPECT_GT(RayCaster<2>(scene.mesh).distance(scene.start), 0.8);
    LidarOptions options;
    options.pattern.max_range = 200.0;
    const auto ranges = SimulatedLidar<2>(scene.mesh, options).scan(scene.start, 0).ranges;
    EXPECT_EQ(std::count_if(ranges.begin(), ranges.end(), [](float r) { return std::isfinite(r); }), 720) << name;
    EXPECT_LT(*std::max_element(ranges.begin(), ranges.end()), scene.domain.size().norm());
  }
}

TEST(SceneFile, Levine) {
  VANTAGE_NEEDS_DATA("levine_stl");
  const auto scene = std::get<Scene<3>>(load_scene_file(data_set("levine_stl") / "levine.stl"));
  expect_good_start(scene);
  EXPECT_EQ(scene.voxel, 0.15);
  EXPECT_NEAR(scene.start[2], 1.7, 0.01);
  const RayCaster<3> world(scene.mesh);
  EXPECT_NEAR(world.cast(scene.start, -Vec<3>::UnitZ()).range, 1.7, 0.01);  // On the corridor's floor.
  EXPECT_LT(world.cast(scene.start, Vec<3>::UnitX()).range, 15.0);
  EXPECT_LT(world.cast(scene.start, -Vec<3>::UnitX()).range, 15.0);
}

TEST(SceneFile, TownStartsOutdoors) {
  VANTAGE_NEEDS_DATA("simple_city");
  const std::filesystem::path folder = data_set("simple_city");
  const auto scene =
      std::get<Scene<3>>(load_scene_file((folder / "simple_city_static.ply").string() + "+" + (folder / "ground_quad_ADDED.obj").string()));
  EXPECT_EQ(scene.mesh.facets.size(), 433748U + 2U);
  expect_good_start(scene);
  EXPECT_NEAR(scene.domain.low[2], 5.01, 0.02);
  EXPECT_NEAR(scene.domain.high[2], 55.5, 0.1);
  EXPECT_NEAR(scene.start[2], 5.01 + 1.7, 0.05);
  const RayCaster<3> world(scene.mesh);
  EXPECT_EQ(world.cast(scene.start, Vec<3>::UnitZ()).range, kInfinity);  // Under the sky.
  EXPECT_NEAR(world.cast(scene.start, -Vec<3>::UnitZ()).range, 1.7, 0.05);
  EXPECT_LT((scene.start - scene.domain.center()).head<2>().norm(), 60.0);
}

TEST(SceneFile, DelftStartsInAStreet) {
  VANTAGE_NEEDS_DATA("delft_cityjson");
  const auto scene = std::get<Scene<3>>(load_scene_file(data_set("delft_cityjson") / "delft.json"));
  expect_good_start(scene);  // Clear of the ground, too, though the cells are larger than a man.
  const RayCaster<3> world(scene.mesh);
  EXPECT_EQ(world.cast(scene.start, Vec<3>::UnitZ()).range, kInfinity);
  EXPECT_NEAR(world.cast(scene.start, -Vec<3>::UnitZ()).range, 1.1 * scene.clearance, 0.3);
  const auto ranges = SimulatedLidar<3>(scene.mesh, {}).scan(scene.start, 0).ranges;
  EXPECT_GT(std::count_if(ranges.begin(), ranges.end(), [](float r) { return std::isfinite(r); }), static_cast<std::ptrdiff_t>(ranges.size() / 2));
}

TEST(SceneFile, GroundIsAddedWhereAskedFor) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "two.city.json";
  // Two walls, 10 m apart, 4 m high, far from the origin and standing at 2 m.
  std::ofstream(path) << R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],"translate":[84616,447423,2]},"CityObjects":{"a":{
    "type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2,3]],[[4,5,6,7]]]}]}},
    "vertices":[[0,0,0],[20,0,0],[20,0,4],[0,0,4],[0,10,0],[20,10,0],[20,10,4],[0,10,4]]})";
  const auto load = [&](double ground) {
    SceneFileOptions options;
    options.ground = ground;
    return std::get<Scene<3>>(load_scene_file(path, options));
  };
  const Scene<3> bare = load(-kInfinity), scene = load(2.0);
  EXPECT_EQ(scene.name, "two");
  EXPECT_EQ(bare.mesh.facets.size(), 4U);
  ASSERT_EQ(scene.mesh.facets.size(), 6U);
  ASSERT_EQ(scene.parts.size(), 2U);
  EXPECT_EQ(scene.parts[1].name, "ground");
  EXPECT_EQ(scene.parts[1].first, 4U);
  // 2 m around the walls, and the domain begins on it.
  EXPECT_EQ(scene.domain.low, Vec<3>(84614, 447421, 2));
  EXPECT_EQ(scene.domain.high.head<2>(), Vec<2>(84638, 447435));
  const RayCaster<3> world(scene.mesh);
  for (const Vec<2>& at : {Vec<2>(84614.01, 447421.01), Vec<2>(84637.9, 447434.9), Vec<2>(84626, 447428)})
    EXPECT_NEAR(world.cast({at[0], at[1], 5.0}, -Vec<3>::UnitZ(), 10.0).range, 3.0, 1e-9);
  expect_good_start(scene);
  EXPECT_NEAR(scene.start[2], 3.7, 1e-9);
  EXPECT_THAT(error_of([&] { (void)load(6.0); }), HasSubstr("scene.ground = 6: must be below the top of the scene, 6 m"));
  EXPECT_THAT(error_of([&] { (void)load(-100.0); }), HasSubstr("lies farther below"));
  SceneFileOptions options;
  options.ground = 0.0;
  EXPECT_THAT(error_of([&] { (void)make_scene("town", options); }), HasSubstr("a built-in scene has its own"));
  options = {};
  options.detail = 1.0;
  EXPECT_THAT(error_of([&] { (void)make_scene("town", options); }), HasSubstr("scene.detail: of city models"));
}

}  // namespace
}  // namespace vantage
