// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <string>
#include <string_view>

#include "vantage/world/scene.h"

namespace vantage {

/// What a generator says of its scene besides the things in it; as in `Scene`.
template <int Dim>
  requires SpatialDim<Dim>
struct SceneSetting {
  std::string name;
  Box<Dim> domain;
  Vec<Dim> start;
  double voxel, eta, range, clearance;  ///< [m]
};

/// The things of a scene, gathered by kind ("wall", "tree", ...) while it is built.
template <int Dim>
  requires SpatialDim<Dim>
class Scenery {
 public:
  /// The mesh to which things of this kind are added; stays where it is.
  [[nodiscard]] Mesh<Dim>& operator[](std::string_view kind) {
    for (Kind& k : kinds_)
      if (k.name == kind) return k.mesh;
    return kinds_.emplace_back(std::string(kind), Mesh<Dim>{}).mesh;
  }
  /// The scene, with one part a kind in the order in which the kinds first came.
  [[nodiscard]] Scene<Dim> scene(const SceneSetting<Dim>& setting) const {
    Scene<Dim> scene;
    scene.name = setting.name;
    scene.domain = setting.domain;
    scene.start = setting.start;
    scene.voxel = setting.voxel;
    scene.eta = setting.eta;
    scene.range = setting.range;
    scene.clearance = setting.clearance;
    for (const Kind& kind : kinds_) append(kind, scene);
    return scene;
  }

 private:
  struct Kind {
    Kind(std::string n, Mesh<Dim> m) : name(std::move(n)), mesh(std::move(m)) {}
    std::string name;
    Mesh<Dim> mesh;
  };
  static void append(const Kind& kind, Scene<Dim>& scene) {
    const auto offset = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    scene.parts.push_back({kind.name, static_cast<std::uint32_t>(scene.mesh.facets.size()), static_cast<std::uint32_t>(kind.mesh.facets.size())});
    scene.mesh.vertices.insert(scene.mesh.vertices.end(), kind.mesh.vertices.begin(), kind.mesh.vertices.end());
    for (typename Mesh<Dim>::Facet facet : kind.mesh.facets) {
      for (std::uint32_t& corner : facet) corner += offset;
      scene.mesh.facets.push_back(facet);
    }
  }

  std::deque<Kind> kinds_;
};

}  // namespace vantage
