// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/walls.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr double kAbove = 1e-5;  // Above the surface on which a place lies [m].
constexpr int kNodes = 3;        // Tried along a ray.

template <int Dim>
Patch<Dim> facet_of(const Mesh<Dim>& mesh, std::size_t facet) {
  Patch<Dim> patch;
  for (const std::uint32_t vertex : mesh.facets[facet]) patch.vertices[static_cast<std::size_t>(patch.count++)] = mesh.vertices[vertex];
  return patch;
}

constexpr std::string_view kClutter[] = {"tree", "vehicle", "furniture", "pole", "wire", "fence", "railing"};

/// Sums of the sizes of the facets that reach into the domain; the others, and clutter that does not count, add nothing.
template <int Dim>
std::vector<double> running_sizes(const Scene<Dim>& scene, bool clutter) {
  std::vector<bool> counts(scene.mesh.facets.size(), true);
  for (const auto& part : scene.parts) {
    const bool left_out = !clutter && std::ranges::find(kClutter, part.name) != std::end(kClutter);
    std::fill_n(counts.begin() + part.first, part.count, !left_out);
  }
  std::vector<double> sums;
  double sum = 0.0;
  for (std::size_t f = 0; f < counts.size(); ++f) {
    const Patch<Dim> facet = facet_of(scene.mesh, f);
    if (counts[f] && !facet.bounds().intersection(scene.domain).empty()) sum += measure(facet);
    sums.push_back(sum);
  }
  return sums;
}

/// A reachable node that sees place k, along one of the directions.
template <int Dim>
std::optional<Vec<Dim>> view_of(const Walls<Dim>& walls, std::size_t k, const Reference<Dim>& reference, const RayCaster<Dim>& truth,
                                std::span<const Vec<Dim>> directions) {
  const Grid<Dim>& grid = reference.nodes.window;
  for (const Vec<Dim>& direction : directions) {
    const double cosine = direction.dot(walls.normals[k]);
    if (std::abs(cosine) < walls.cosine) continue;
    const Vec<Dim> origin = walls.places[k] + (cosine > 0.0 ? kAbove : -kAbove) * walls.normals[k];
    const double end = std::min(walls.range, truth.cast(origin, direction, walls.range).range);
    int tried = 0;
    for (double t = 0.5 * grid.spacing; t < end && tried < kNodes; t += grid.spacing) {
      const Index<Dim> at = grid.nearest(origin + t * direction);
      if (!grid.inside(at)) break;
      if (!reference.nodes.at(at).reachable) continue;
      ++tried;
      if (const Vec<Dim> node = grid.position(at); walls.sees(truth, node, k)) return node;
    }
  }
  return std::nullopt;
}

}  // namespace

void describe(WallOptions& o, const OptionVisitor& visit) {
  visit("places", o.places, "", Range{1, 1e8}, "places drawn on the true surface");
  visit("cosine", o.cosine, "", Range{0.0, 1.0}, "least cosine between line of sight and normal");
  visit("seed", o.seed, "", Range{0, 9e15}, "of the choice of places");
  visit("clutter", o.clutter, "trees, vehicles, furniture, poles, wires, fences and railings count too");
}

template <int Dim>
Vec<Dim> place_on(const Patch<Dim>& simplex, Random& random) {
  std::array<double, Dim> cuts;  // The gaps between sorted numbers are even on a simplex.
  for (double& cut : cuts) cut = random.uniform();
  cuts.back() = 1.0;
  std::ranges::sort(cuts);
  Vec<Dim> p = cuts[0] * simplex.vertices[0];
  for (std::size_t k = 1; k < cuts.size(); ++k) p += (cuts[k] - cuts[k - 1]) * simplex.vertices[k];
  return p;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Walls<Dim>::sees(const RayCaster<Dim>& truth, const Vec<Dim>& from, std::size_t k) const {
  const Vec<Dim> to = places[k] - from;
  const double length = to.norm();
  return length <= range && std::abs(to.dot(normals[k])) >= cosine * length && in_sight(truth, from, places[k]);
}

template <int Dim>
Walls<Dim> reachable_walls(const Reference<Dim>& reference, const Scene<Dim>& scene, const RayCaster<Dim>& truth, const WallOptions& options) {
  check_options(options, "audit.walls");
  const std::vector<double> sums = running_sizes(scene, options.clutter);
  const double total = sums.empty() ? 0.0 : sums.back();
  Walls<Dim> drawn;
  drawn.cosine = options.cosine;
  drawn.range = reference.options.range;
  Random random(static_cast<std::uint64_t>(options.seed));
  for (std::int64_t i = 0; i < options.places && total > 0.0; ++i) {
    const double at = (static_cast<double>(i) + random.uniform()) / static_cast<double>(options.places) * total;
    const auto facet =
        std::min<std::size_t>(static_cast<std::size_t>(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin()), sums.size() - 1);
    const Patch<Dim> patch = facet_of(scene.mesh, facet);
    const Vec<Dim> p = place_on(patch, random);
    if (!scene.domain.grown(kAbove).contains(p)) continue;
    drawn.places.push_back(p);
    drawn.normals.push_back(normal(patch));
  }
  const std::vector<Vec<Dim>> directions = fixed_directions<Dim>(reference.options.rays);
  std::vector<std::optional<Vec<Dim>>> views(drawn.places.size());
  parallel_for(views.size(), 16, [&](std::size_t k) { views[k] = view_of<Dim>(drawn, k, reference, truth, directions); });
  Walls<Dim> walls;
  walls.cosine = drawn.cosine;
  walls.range = drawn.range;
  for (std::size_t k = 0; k < views.size(); ++k) {
    if (!views[k]) continue;
    walls.places.push_back(drawn.places[k]);
    walls.normals.push_back(drawn.normals[k]);
    walls.views.push_back(*views[k]);
  }
  walls.area = total * static_cast<double>(walls.places.size()) / static_cast<double>(options.places);
  return walls;
}

template <int Dim>
std::vector<double> walls_seen(const Walls<Dim>& walls, const RayCaster<Dim>& truth, std::span<const Vec<Dim>> scans) {
  if (walls.places.empty()) return {};
  std::vector<std::size_t> first(walls.places.size());  // The scan that sees a place.
  parallel_for(first.size(), 64, [&](std::size_t k) {
    while (first[k] < scans.size() && !walls.sees(truth, scans[first[k]], k)) ++first[k];
  });
  std::vector<double> seen(scans.size());
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const auto count = std::count_if(first.begin(), first.end(), [s](std::size_t f) { return f <= s; });
    seen[s] = static_cast<double>(count) / static_cast<double>(first.size());
  }
  return seen;
}

template struct Walls<2>;
template struct Walls<3>;
template Vec<2> place_on<2>(const Patch<2>&, Random&);
template Vec<3> place_on<3>(const Patch<3>&, Random&);
template Walls<2> reachable_walls<2>(const Reference<2>&, const Scene<2>&, const RayCaster<2>&, const WallOptions&);
template Walls<3> reachable_walls<3>(const Reference<3>&, const Scene<3>&, const RayCaster<3>&, const WallOptions&);
template std::vector<double> walls_seen<2>(const Walls<2>&, const RayCaster<2>&, std::span<const Vec<2>>);
template std::vector<double> walls_seen<3>(const Walls<3>&, const RayCaster<3>&, std::span<const Vec<3>>);

}  // namespace vantage
