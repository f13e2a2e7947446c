// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/scene.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <map>
#include <numeric>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/geometry/patch.h"
#include "vantage/geometry/ray_caster.h"

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

TEST(Scene, DomainCoversTheThings) {
  for_every_scene([]<int Dim>(const Scene<Dim>& scene) {
    if (scene.name == "office" || scene.name == "patio" || scene.name == "floor" || scene.name == "galleries")
      return;  // Their buildings go on beyond the domain.
    Box<Dim> things;
    for (const auto& part : scene.parts)
      for (std::uint32_t f = part.first; f < part.first + part.count && part.name != "ground"; ++f)
        for (std::uint32_t corner : scene.mesh.facets[f]) things.extend(scene.mesh.vertices[corner]);
    EXPECT_TRUE(scene.domain.contains(things.low) && scene.domain.contains(things.high))
        << things.low.transpose() << " .. " << things.high.transpose();
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

TEST(Scene, EverySeedOfTheLargeWorldsIsClosedWithAFreeStart) {
  for (int seed = 0; seed < 40; ++seed) {
    const std::string with_seed = "seed=" + std::to_string(seed);
    for (const std::string& spec : {"floor:rooms=" + std::to_string(12 + seed) + "," + with_seed, "galleries:columns=3,rows=3," + with_seed,
                                    "forest:trees=" + std::to_string(1 + 3 * seed) + "," + with_seed}) {
      SCOPED_TRACE(spec);
      const auto scene = std::get<Scene<3>>(make_scene(spec));
      for (const auto& part : scene.parts) {
        if (part.name != "ground") {
          EXPECT_EQ(open_sides(scene.mesh, part.first, part.count), 0) << part.name;
        }
      }
      EXPECT_GE(distance_to(scene.mesh, scene.start), scene.clearance);
      EXPECT_EQ(solids_round(scene, scene.start), 0);
    }
  }
}

/// Rays that leave the domain from its start without meeting anything.
int rays_out(const Scene<3>& scene) {
  const RayCaster<3> world(scene.mesh);
  Random random(7);
  int out = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec<3> direction = Vec<3>{random.normal(), random.normal(), random.normal()}.normalized();
    const double range = world.cast(scene.start, direction).range;
    out += range < kInfinity && scene.domain.contains(scene.start + range * direction) ? 0 : 1;
  }
  return out;
}

TEST(Scene, FloorsAndGalleriesAreEnclosed) {
  for (int seed = 1; seed <= 10; ++seed)
    for (const char* name : {"floor", "galleries"})
      EXPECT_EQ(rays_out(std::get<Scene<3>>(make_scene(name + std::string(":seed=") + std::to_string(seed)))), 0) << name << seed;
  EXPECT_GT(rays_out(std::get<Scene<3>>(make_scene("forest"))), 100);
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

/// The connected bodies of one part: the places of each.
std::vector<std::vector<Vec<3>>> bodies(const Scene<3>& scene, std::string_view kind) {
  const auto part = std::find_if(scene.parts.begin(), scene.parts.end(), [&](const auto& p) { return p.name == kind; });
  std::vector<std::uint32_t> parent(scene.mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::map<std::uint32_t, std::vector<Vec<3>>> found;
  for (std::uint32_t f = part->first; f < part->first + part->count; ++f)
    for (std::uint32_t corner : scene.mesh.facets[f]) parent[root(corner)] = root(scene.mesh.facets[f][0]);
  for (std::uint32_t f = part->first; f < part->first + part->count; ++f)
    for (std::uint32_t corner : scene.mesh.facets[f]) found[root(corner)].push_back(scene.mesh.vertices[corner]);
  std::vector<std::vector<Vec<3>>> all;
  for (auto& [key, places] : found) all.push_back(std::move(places));
  return all;
}

/// Widest gap between two bodies, seen from above, across the sides of the first; negative if they overlap [m].
double gap_between(const std::vector<Vec<3>>& a, const std::vector<Vec<3>>& b) {
  const auto span = [](const std::vector<Vec<3>>& places, const Vec<2>& axis) {
    std::array<double, 2> range{kInfinity, -kInfinity};
    for (const Vec<3>& p : places) range = {std::min(range[0], axis.dot(p.head<2>())), std::max(range[1], axis.dot(p.head<2>()))};
    return range;
  };
  Vec<2> side = Vec<2>::Zero();
  for (std::size_t i = 1; i < a.size() && side.norm() < 0.1; ++i) side = (a[i] - a[0]).head<2>();
  side.normalize();
  double widest = -kInfinity;
  for (const Vec<2>& axis : {side, Vec<2>(-side[1], side[0])}) {
    const auto ours = span(a, axis), theirs = span(b, axis);
    widest = std::max({widest, ours[0] - theirs[1], theirs[0] - ours[1]});
  }
  return widest;
}

/// The places of a body below a height.
std::vector<Vec<3>> foot_of(const std::vector<Vec<3>>& body, double height) {
  std::vector<Vec<3>> foot;
  std::copy_if(body.begin(), body.end(), std::back_inserter(foot), [&](const Vec<3>& p) { return p[2] < height; });
  return foot;
}

TEST(Town, HasThirtyBuildingsApart) {
  for (const char* spec : {"town", "town:seed=5"}) {
    const auto town = std::get<Scene<3>>(make_scene(spec));
    EXPECT_LT(town.mesh.facets.size(), 200000u);
    std::vector<std::vector<Vec<3>>> buildings;
    for (const char* kind : {"house", "church"})
      for (const auto& body : bodies(town, kind)) buildings.push_back(foot_of(body, 0.0));
    EXPECT_EQ(buildings.size(), 30u);
    for (std::size_t i = 0; i < buildings.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE(std::max(gap_between(buildings[i], buildings[j]), gap_between(buildings[j], buildings[i])), 1.0);
    for (const char* kind : {"pole", "vehicle", "tree"})
      for (const auto& thing : bodies(town, kind)) {
        const std::vector<Vec<3>> foot = foot_of(thing, 2.0);
        if (foot.empty()) continue;  // A crown or a lamp.
        for (const auto& building : buildings) EXPECT_GE(gap_between(building, foot), 0.3) << kind << " " << foot[0].transpose();
      }
    for (const char* kind : {"wall", "roof", "wire", "furniture", "column", "stair", "kerb"}) EXPECT_FALSE(bodies(town, kind).empty()) << kind;
  }
}

TEST(Town, WiresAreThinAndHangBetweenPoles) {
  const auto town = std::get<Scene<3>>(make_scene("town"));
  const auto poles = bodies(town, "pole");
  for (const auto& wire : bodies(town, "wire")) {
    double low = kInfinity, high = 0.0;
    for (const Vec<3>& p : wire) low = std::min(low, p[2]), high = std::max(high, p[2]);
    EXPECT_GT(low, 5.0);
    EXPECT_GT(high - low, 0.4);                        // Sag.
    const double across = (wire[0] - wire[2]).norm();  // Neighbouring corners of a hexagon: its radius.
    EXPECT_GE(across, 0.009);
    EXPECT_LE(across, 0.021);
    EXPECT_TRUE(std::any_of(poles.begin(), poles.end(), [&](const auto& pole) { return (pole[0] - wire[0]).template head<2>().norm() < 1.5; }));
  }
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
