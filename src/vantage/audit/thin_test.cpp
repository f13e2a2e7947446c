// SPDX-License-Identifier: Apache-2.0
// Thin structures: nothing that was seen is lost, and little is spent on it.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <set>

#include "vantage/audit/box_tree.h"
#include "vantage/audit/test_clouds.h"
#include "vantage/geometry/ray_caster.h"
#include "vantage/io/point_cloud_file.h"
#include "vantage/io/test_data.h"
#include "vantage/world/lidar.h"
#include "vantage/world/scene.h"

namespace vantage {
namespace {

using test::anywhere;
using test::Cloud;

/// Returns of a straight cable of 10 mm.
template <int Dim>
struct Cable {
  Vec<Dim> from, to;
  Cloud<Dim> returns;
};

/// `count` returns about `spacing` apart, off by up to a tenth of that along it, anywhere and in any direction.
template <int Dim>
Cable<Dim> any_cable(int count, double spacing, Random& random) {
  Cable<Dim> cable;
  const Vec<Dim> along = anywhere<Dim>(random, 1.0).normalized();
  cable.from = anywhere<Dim>(random, 4.0);
  cable.from[Dim - 1] = random.uniform(-1.0, 8.0);
  cable.to = cable.from + (count - 1) * spacing * along;
  for (int i = 0; i < count; ++i)
    cable.returns.push_back(cable.from + (i + random.uniform(-0.1, 0.1)) * spacing * along + 0.005 * anywhere<Dim>(random, 1.0).normalized());
  return cable;
}

/// Cubes of `side` that hold points.
template <int Dim>
std::size_t cubes(const Cloud<Dim>& cloud, double side) {
  std::set<std::vector<double>> found;
  for (const Vec<Dim>& p : cloud) {
    const Vec<Dim> cube = (p / side).array().floor();
    found.emplace(cube.data(), cube.data() + Dim);
  }
  return found.size();
}

template <int Dim>
HausdorffTree<Dim> tree_in_cube(const Cloud<Dim>& cloud, double eta) {
  HausdorffTree<Dim> tree({Vec<Dim>::Constant(-30.0), Vec<Dim>::Constant(30.0)}, {.eta = eta});
  tree.insert(cloud);
  return tree;
}

template <class T>
class CableIn : public ::testing::Test {};
using Dims = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CableIn, Dims);

TYPED_TEST(CableIn, AnyDirectionIsKeptByAFewSegments) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double eta = *rc::gen::element(0.03, 0.05, 0.1, 0.2);
    const auto cable = any_cable<Dim>(5 + static_cast<int>(random.below(60)), random.uniform(0.05, 1.5) * eta, random);
    const auto tree = tree_in_cube<Dim>(cable.returns, eta);
    const auto patches = tree.patches();
    const auto report = check_certificate<Dim>(cable.returns, patches, test::certificate_of(tree));
    RC_ASSERT(report.holds());
    RC_ASSERT(report.data_to_surface.max <= eta);
    RC_ASSERT(patches.size() <= 3 * cubes<Dim>(cable.returns, 1.0));
    // Not only the returns: the cable between them.
    for (double t = 0.0; t <= 1.0; t += 0.01) {
      double least = kInfinity;
      for (const auto& patch : patches) least = std::min(least, distance(patch, Vec<Dim>(cable.from + t * (cable.to - cable.from))));
      RC_ASSERT(least <= eta);
    }
  }));
}

TYPED_TEST(CableIn, FarApartReturnsStandForThemselves) {
  constexpr int Dim = TypeParam::value;
  EXPECT_TRUE(rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const double eta = *rc::gen::element(0.03, 0.05, 0.1);
    const auto cable = any_cable<Dim>(5 + static_cast<int>(random.below(30)), random.uniform(1.5, 8.0) * eta, random);
    const auto tree = tree_in_cube<Dim>(cable.returns, eta);
    const auto patches = tree.patches();
    const auto report = check_certificate<Dim>(cable.returns, patches, test::certificate_of(tree));
    RC_ASSERT(report.holds());
    RC_ASSERT(report.data_to_surface.max <= eta);
    RC_ASSERT(patches.size() <= cable.returns.size());
  }));
}

TEST(Cable, AboveGroundIsKeptByAFewSegments) {
  Random random(4);
  for (int trial = 0; trial < 40; ++trial) {
    const double eta = trial % 2 == 0 ? 0.1 : 0.2;
    const auto cable = any_cable<3>(5 + static_cast<int>(random.below(60)), random.uniform(0.05, 1.5) * eta, random);
    Cloud<3> cloud;
    for (int i = 0; i < 10000; ++i) {
      cloud.push_back(anywhere<3>(random, 5.0));
      cloud.back()[2] = -1.5;
    }
    cloud.insert(cloud.end(), cable.returns.begin(), cable.returns.end());
    const auto patches = tree_in_cube<3>(cloud, eta).patches();
    for (const auto& p : cable.returns)
      EXPECT_TRUE(std::any_of(patches.begin(), patches.end(), [&](const auto& patch) { return distance(patch, p) <= eta; }));
    const auto axis = segment_patch<3>(cable.from, cable.to);
    const auto on_cable = std::count_if(patches.begin(), patches.end(), [&](const auto& patch) {
      const Vec<3> center = patch.bounds().center();
      return distance(axis, center) < eta && center[2] > -1.5 + eta;
    });
    EXPECT_LE(on_cable, 3 * static_cast<std::ptrdiff_t>(cubes<3>(cable.returns, 1.0))) << trial;
  }
}

// The scene -----------------------------------------------------------------------------------------------------------------------------------------

Mesh<3> mesh_of(const Scene<3>& scene, const Scene<3>::Part& part) {
  Mesh<3> mesh;
  mesh.vertices = scene.mesh.vertices;
  mesh.facets.assign(scene.mesh.facets.begin() + part.first, scene.mesh.facets.begin() + part.first + part.count);
  return mesh;
}

/// Random places on a mesh, `per_metre2` of them.
Cloud<3> places_on(const Mesh<3>& mesh, double per_metre2) {
  Random random(6);
  Cloud<3> places;
  for (const auto& facet : mesh.facets) {
    const Vec<3>&a = mesh.vertices[facet[0]], &b = mesh.vertices[facet[1]], &c = mesh.vertices[facet[2]];
    Patch<3> triangle;
    for (const Vec<3>& v : {a, b, c}) triangle.vertices[triangle.count++] = v;
    const double wanted = per_metre2 * measure(triangle) + random.uniform();
    for (int i = 1; i <= wanted; ++i) {
      double s = random.uniform(), t = random.uniform();
      if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
      places.push_back(a + s * (b - a) + t * (c - a));
    }
  }
  return places;
}

/// The scene `wires` and what five scans of it return, from all sides, 4 to 30 m away.
class WiresScene : public ::testing::TestWithParam<double> {
 protected:
  const Scene<3> scene_ = std::get<Scene<3>>(make_scene("wires"));

  [[nodiscard]] const Cloud<3>& cloud() const {
    static const Cloud<3> cloud = [this] {
      LidarOptions lidar;
      lidar.pattern.vertical_fov = radians(60.0);
      SimulatedLidar<3> sensor(scene_.mesh, lidar);
      const Vec<3> stations[] = {{20.0, 4.0, 1.6}, {8.0, 11.0, 1.6}, {32.0, 11.0, 1.6}, {30.0, 20.5, 1.6}, {10.0, 21.0, 1.6}};
      Cloud<3> all;
      for (int i = 0; i < 5; ++i)
        for (const Vec<3>& p : hit_points(sensor.scan(stations[i], i))) all.push_back(p);
      return all;
    }();
    return cloud;
  }
  [[nodiscard]] Cloud<3> returns_of(const RayCaster<3>& part) const {
    Cloud<3> returns;  // Ranges are floats: good to a few micrometres here.
    std::copy_if(cloud().begin(), cloud().end(), std::back_inserter(returns), [&](const Vec<3>& p) { return part.distance(p, 1e-3) < 1e-4; });
    return returns;
  }
};

TEST_P(WiresScene, NothingThinIsLostAndItCostsLessThanVoxels) {
  const double eta = GetParam();
  const auto tree = test::reconstruct<3>(cloud(), {.eta = eta});
  const auto patches = tree.patches();
  const auto report = check_certificate<3>(cloud(), patches, test::certificate_of(tree));
  EXPECT_TRUE(report.holds()) << report.faults.front();
  EXPECT_LE(report.data_to_surface.max, eta);
  const BoxTree<3> boxes(patches.size(), [&](std::uint32_t i) { return patches[i].bounds(); });
  const auto near = [&](const Vec<3>& p) { return boxes.any_within(p, eta, [&](std::uint32_t i) { return distance(patches[i], p) <= eta; }); };
  for (const auto& part : scene_.parts) {
    if (part.name == "ground") continue;
    SCOPED_TRACE(part.name);
    const Mesh<3> mesh = mesh_of(scene_, part);
    const RayCaster<3> truth(mesh);
    const Cloud<3> returns = returns_of(truth);
    ASSERT_GT(returns.size(), 300U);
    EXPECT_TRUE(std::all_of(returns.begin(), returns.end(), near));
    // Of the thing itself, so far as it was observed: a return is near.
    const BoxTree<3> seen(returns.size(), [&](std::uint32_t i) { return Box<3>{returns[i], returns[i]}; });
    std::size_t observed = 0, kept = 0;
    for (const Vec<3>& p : places_on(mesh, 300.0)) {
      if (!seen.any_within(p, 0.5 * eta, [&](std::uint32_t i) { return (returns[i] - p).norm() <= 0.5 * eta; })) continue;
      ++observed;
      kept += near(p) ? 1 : 0;
    }
    ASSERT_GT(observed, 100U);
    EXPECT_GE(static_cast<double>(kept), 0.99 * static_cast<double>(observed));
    // Voxels of the same error, half a diagonal, are the yardstick.
    const auto spent = std::count_if(patches.begin(), patches.end(), [&](const Patch<3>& patch) {
      return std::all_of(patch.corners().begin(), patch.corners().end(), [&](const Vec<3>& v) { return truth.distance(v, 1.0) < eta; });
    });
    EXPECT_LT(spent, static_cast<std::ptrdiff_t>(cubes<3>(returns, 2.0 * eta / std::sqrt(3.0))));
  }
}

INSTANTIATE_TEST_SUITE_P(Eta, WiresScene, ::testing::Values(0.05, 0.1, 0.2));

TEST(Lamppost, IsKeptByFewPatches) {
  VANTAGE_NEEDS_DATA("pcl_pcd");
  const Cloud<3> cloud = read_points(data_set("pcl_pcd") / "lamppost.pcd").points;
  for (const double eta : {0.05, 0.1, 0.2}) {
    const auto tree = test::reconstruct<3>(cloud, {.eta = eta});
    const auto patches = tree.patches();
    const auto report = check_certificate<3>(cloud, patches, test::certificate_of(tree));
    EXPECT_TRUE(report.holds()) << report.faults.front();
    EXPECT_LE(report.data_to_surface.max, eta);
    EXPECT_LE(3 * patches.size(), cubes<3>(cloud, 2.0 * eta / std::sqrt(3.0)));  // Voxels of the same error.
  }
}

}  // namespace
}  // namespace vantage
