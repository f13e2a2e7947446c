// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/scene.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <map>

#include "vantage/base/error.h"
#include "vantage/geometry/patch.h"

namespace vantage {
namespace {

/// Runs `body(scene)` for every built-in scene as it stands in the list.
template <class Body>
void for_every_scene(Body&& body) {
  for (const SceneInfo& info : scene_list()) {
    SCOPED_TRACE(info.name);
    std::visit(body, make_scene(info.name));
  }
}

/// Sides of facets (edges in 3D, ends in 2D) that are not shared by exactly two facets, in opposite directions.
template <int Dim>
int open_sides(const Mesh<Dim>& mesh, std::uint32_t first, std::uint32_t count) {
  using Side = std::array<std::uint32_t, Dim - 1>;
  std::map<Side, std::array<int, 2>> sides;  // Facets, and sum of their signs.
  for (std::uint32_t f = first; f < first + count; ++f)
    for (int left_out = 0; left_out < Dim; ++left_out) {
      Side side;
      for (int i = 0; i + 1 < Dim; ++i) side[static_cast<std::size_t>(i)] = mesh.facets[f][static_cast<std::size_t>((left_out + 1 + i) % Dim)];
      int sign = left_out * (Dim - 1) % 2 == 0 ? 1 : -1;
      if (!std::is_sorted(side.begin(), side.end())) {
        std::reverse(side.begin(), side.end());
        sign = -sign;
      }
      sides[side][0] += 1;
      sides[side][1] += sign;
    }
  return static_cast<int>(std::count_if(sides.begin(), sides.end(), [](const auto& s) { return s.second != std::array<int, 2>{2, 0}; }));
}

template <int Dim>
Patch<Dim> facet_patch(const Mesh<Dim>& mesh, std::uint32_t facet) {
  Patch<Dim> patch;
  for (std::uint32_t corner : mesh.facets[facet]) patch.vertices[static_cast<std::size_t>(patch.count++)] = mesh.vertices[corner];
  return patch;
}

template <int Dim>
double distance_to(const Mesh<Dim>& mesh, const Vec<Dim>& p) {
  double least = kInfinity;
  for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) least = std::min(least, distance(facet_patch(mesh, f), p));
  return least;
}

/// Surfaces that a ray leaves minus surfaces it enters: 0 outside of every solid.
template <int Dim>
int solids_round(const Scene<Dim>& scene, const Vec<Dim>& p) {
  const Vec<Dim> direction = Vec<Dim>::LinSpaced(0.3, 0.9).normalized();
  int solids = 0;
  for (const auto& part : scene.parts)
    for (std::uint32_t f = part.first; f < part.first + part.count && part.name != "ground"; ++f) {
      const Patch<Dim> patch = facet_patch(scene.mesh, f);
      if (!ray_range(patch, p, direction, 0.0)) continue;
      Eigen::Matrix<double, Dim, Dim> edges;  // Its determinant's sign is that of (outward normal) . direction.
      edges.col(0) = direction;
      for (int i = 1; i < Dim; ++i) edges.col(i) = patch.vertices[static_cast<std::size_t>(i)] - patch.vertices[0];
      solids += edges.determinant() > 0.0 ? 1 : -1;
    }
  return solids;
}

TEST(Scene, SolidsAreClosedAndFaceOutwards) {
  for_every_scene([]<int Dim>(const Scene<Dim>& scene) {
    for (const auto& part : scene.parts) {
      if (part.name == "ground") continue;
      EXPECT_EQ(open_sides(scene.mesh, part.first, part.count), 0) << part.name;
    }
  });
}

TEST(Scene, PartsCoverTheFacetsInOrder) {
  for_every_scene([]<int Dim>(const Scene<Dim>& scene) {
    std::uint32_t next = 0;
    for (const auto& part : scene.parts) {
      EXPECT_EQ(part.first, next) << part.name;
      EXPECT_GT(part.count, 0u) << part.name;
      next += part.count;
    }
    EXPECT_EQ(next, scene.mesh.facets.size());
  });
}

TEST(Scene, StartIsFreeWithClearance) {
  for_every_scene([]<int Dim>(const Scene<Dim>& scene) {
    EXPECT_TRUE(scene.domain.grown(-scene.clearance).contains(scene.start));
    EXPECT_GE(distance_to(scene.mesh, scene.start), scene.clearance);
    EXPECT_EQ(solids_round(scene, scene.start), 0);
    EXPECT_GE(scene.range, scene.voxel);
    EXPECT_LT(scene.eta, scene.voxel);
  });
}

TEST(Scene, EqualSeedsGiveEqualBytesAndOthersDoNot) {
  for (const SceneInfo& info : scene_list()) {
    SCOPED_TRACE(info.name);
    std::visit(
        [&]<int Dim>(const Scene<Dim>& once) {
          const auto again = std::get<Scene<Dim>>(make_scene(info.name + ":seed=1"));
          const auto other = std::get<Scene<Dim>>(make_scene(info.name + ":seed=2"));
          EXPECT_EQ(once.mesh.facets, again.mesh.facets);
          EXPECT_TRUE(once.mesh.vertices == again.mesh.vertices);
          EXPECT_FALSE(once.mesh.vertices == other.mesh.vertices);
        },
        make_scene(info.name));
  }
}

TEST(Scene, CountsAreKept) {
  const auto facets = [](std::string_view spec) { return std::visit([](const auto& scene) { return scene.mesh.facets.size(); }, make_scene(spec)); };
  for (int n : {1, 6, 24}) {
    EXPECT_EQ(facets("pipes:cylinders=" + std::to_string(n)), static_cast<std::size_t>(n) * (24 * 4 - 4));
    EXPECT_EQ(facets("pipes:symmetric=1,cylinders=" + std::to_string(n)), static_cast<std::size_t>(n) * (24 * 4 - 4));
  }
  EXPECT_EQ(facets("planar:blobs=12,seed=7"), 1200u);
  EXPECT_EQ(facets("discs:discs=40,seed=7"), 40u * 64u);
}

std::string message_of(std::string_view spec) {
  try {
    static_cast<void>(make_scene(spec));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "no error";
}

TEST(Scene, WrongSpecsAreNamed) {
  EXPECT_EQ(message_of("pipes:cylinders=99"), "pipes:cylinders=99: scene pipes: cylinders = 99: must be a whole number, 1 .. 24");
  EXPECT_EQ(message_of("pipes:cylinders=two"), "pipes:cylinders=two: scene pipes: cylinders = two: must be a whole number, 1 .. 24");
  EXPECT_EQ(message_of("pipes:cylinders"), "pipes:cylinders: scene pipes: cylinders = : must be a whole number, 1 .. 24");
  EXPECT_EQ(message_of("pipes:wires=3"), "pipes:wires=3: scene pipes: unknown parameter 'wires': must be one of cylinders, symmetric, seed");
  const std::string unknown = message_of("planetarium");
  EXPECT_NE(unknown.find("did you mean 'planar'"), std::string::npos) << unknown;
  for (const SceneInfo& info : scene_list()) EXPECT_NE(unknown.find(info.name), std::string::npos) << unknown;
}

TEST(Scene, ListDescribesWhatIsBuilt) {
  for (const SceneInfo& info : scene_list()) {
    EXPECT_FALSE(info.description.empty());
    EXPECT_EQ(info.parameters.back().name, "seed");
    std::visit(
        [&]<int Dim>(const Scene<Dim>& scene) {
          EXPECT_EQ(scene.name, info.name);
          EXPECT_EQ(Dim, info.dim);
        },
        make_scene(info.name));
  }
}

}  // namespace
}  // namespace vantage
