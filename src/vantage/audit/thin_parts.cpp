// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/thin_parts.h"

#include "vantage/audit/walls.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kDensity = 300.0;  // Places [1/m^(Dim-1)].
constexpr double kObserved = 0.05;  // From a return [m].
constexpr double kFound = 0.1;      // From the reconstruction [m].

template <int Dim>
std::vector<Vec<Dim>> places_on_thin_parts(const Scene<Dim>& scene) {
  Random random(1);
  std::vector<Vec<Dim>> places;
  for (const auto& part : scene.parts) {
    if (part.name != "pole" && part.name != "wire") continue;
    for (std::uint32_t f = part.first; f < part.first + part.count; ++f) {
      Patch<Dim> facet;
      for (const std::uint32_t v : scene.mesh.facets[f]) facet.vertices[static_cast<std::size_t>(facet.count++)] = scene.mesh.vertices[v];
      const double wanted = kDensity * measure(facet) + random.uniform();
      for (int i = 1; i <= wanted; ++i) places.push_back(place_on(facet, random));
    }
  }
  return places;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
ThinParts<Dim>::ThinParts(const Scene<Dim>& scene)
    : places_(places_on_thin_parts(scene)),
      tree_(places_.size(), [this](std::uint32_t i) { return Box<Dim>{places_[i], places_[i]}; }),
      observed_(places_.size()) {}

template <int Dim>
  requires SpatialDim<Dim>
void ThinParts<Dim>::observe(std::span<const Vec<Dim>> returns) {
  for (const Vec<Dim>& p : returns)
    (void)tree_.any_within(p, kObserved, [&](std::uint32_t i) {
      if ((places_[i] - p).squaredNorm() <= kObserved * kObserved) observed_[i] = true;
      return false;  // All of them.
    });
}

template <int Dim>
  requires SpatialDim<Dim>
std::optional<double> ThinParts<Dim>::recall(std::span<const Patch<Dim>> surface) const {
  const BoxTree<Dim> tree(surface.size(), [&](std::uint32_t i) { return surface[i].bounds(); });
  std::vector<std::uint8_t> found(places_.size());
  parallel_for(places_.size(), 256, [&](std::size_t k) {
    found[k] = observed_[k] && tree.any_within(places_[k], kFound, [&](std::uint32_t i) { return distance(surface[i], places_[k]) <= kFound; });
  });
  std::size_t observed = 0, kept = 0;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    observed += observed_[k] ? 1 : 0;
    kept += found[k];
  }
  if (observed == 0) return std::nullopt;
  return static_cast<double>(kept) / static_cast<double>(observed);
}

template class ThinParts<2>;
template class ThinParts<3>;

}  // namespace vantage
