// SPDX-License-Identifier: Apache-2.0
#include "vantage/survey/sight.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vantage/audit/draw.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// Normal times the content of a facet: the generalised cross product of its edges.
template <int Dim>
Vec<Dim> facet_normal(const Mesh<Dim>& mesh, std::size_t facet) {
  Eigen::Matrix<double, Dim, Dim> edges;
  for (int i = 1; i < Dim; ++i) edges.col(i) = mesh.vertices[mesh.facets[facet][static_cast<std::size_t>(i)]] - mesh.vertices[mesh.facets[facet][0]];
  Vec<Dim> normal;
  for (int a = 0; a < Dim; ++a) {
    edges.col(0) = Vec<Dim>::Unit(a);
    normal[a] = edges.determinant() / (Dim - 1);  // (Dim - 1)! for Dim = 2 and 3.
  }
  return normal;
}

/// Uniform in a simplex: gaps between sorted uniform numbers are its weights.
template <int Dim>
Vec<Dim> place_on(const Mesh<Dim>& mesh, std::size_t facet, Random& random) {
  std::array<double, Dim + 1> cuts{};
  for (int i = 1; i < Dim; ++i) cuts[static_cast<std::size_t>(i)] = random.uniform();
  cuts[Dim] = 1.0;
  std::sort(cuts.begin(), cuts.end());
  Vec<Dim> place = Vec<Dim>::Zero();
  for (std::size_t i = 0; i < Dim; ++i) place += (cuts[i + 1] - cuts[i]) * mesh.vertices[mesh.facets[facet][i]];
  return place;
}

template <int Dim>
double mesh_content(const Mesh<Dim>& mesh) {
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) sum += facet_normal(mesh, f).norm();
  return sum;
}

template <int Dim>
class Builder {
 public:
  Builder(const Scene<Dim>& scene, const RayCaster<Dim>& truth, const Reference<Dim>& reference, const SurveyOptions& options)
      : scene_(scene), truth_(truth), reference_(reference), options_(options), random_(static_cast<std::uint64_t>(options.seed), 1) {}

  SightLines<Dim> build() {
    lines_.ways = find_ways(truth_, reference_, scene_.start, options_);
    collect_demands();
    const auto nodes = standing_nodes();
    require_height(!nodes.empty(), options_);
    is_place_.assign(grid().size(), 0);
    for (const std::size_t node : nodes) is_place_[node] = 1;
    for (const std::size_t node : draw(nodes, static_cast<std::size_t>(options_.candidates), random_)) add_candidate(node);
    look_from(0);
    for (std::int64_t round = 0; round < options_.cover; ++round) add_missing_views();
    keep_what_is_seen();
    return std::move(lines_);
  }

 private:
  const Grid<Dim>& grid() const { return reference_.nodes.window; }

  void collect_demands() {
    lines_.demands = surface_demands(scene_, options_.samples, static_cast<std::uint64_t>(options_.seed));
    lines_.walls = lines_.demands.size();
    lines_.each = mesh_content(scene_.mesh) / static_cast<double>(options_.samples);
    if (!options_.volume) return;
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < grid().size(); ++i)
      if (reference_.nodes[i].counts()) free.push_back(i);
    for (const std::size_t i : draw(free, static_cast<std::size_t>(options_.samples), random_))
      lines_.demands.push_back({grid().position(i), Vec<Dim>::Zero()});
  }

  /// Nodes of the ways at the height asked for.
  std::vector<std::size_t> standing_nodes() const {
    std::vector<char> stands(grid().size());
    parallel_for(stands.size(), 1024, [&](std::size_t i) {
      stands[i] = lines_.ways.nodes[i] != 0 && is_high(truth_, grid().position(i), options_.height, 0.5 * grid().spacing) ? 1 : 0;
    });
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < stands.size(); ++i)
      if (stands[i]) nodes.push_back(i);
    return nodes;
  }

  void add_candidate(std::size_t node) {
    is_place_[node] = 2;
    lines_.candidates.push_back(grid().position(node));
  }

  /// What the candidates from `first` on see.
  void look_from(std::size_t first) {
    auto& sets = lines_.problem.sets;
    sets.resize(lines_.candidates.size());
    seers_.resize(lines_.demands.size());
    parallel_for(sets.size() - first, 1, [&](std::size_t k) {
      for (std::size_t i = 0; i < lines_.demands.size(); ++i)
        if (measures(truth_, lines_.candidates[first + k], lines_.demands[i], options_)) sets[first + k].push_back(static_cast<std::uint32_t>(i));
    });
    for (std::size_t c = first; c < sets.size(); ++c)
      for (const std::uint32_t i : sets[c]) ++seers_[i];
  }

  /// A place along a ray from the demand that measures it and is no candidate yet.
  std::size_t view_of(const Demand<Dim>& demand, std::span<const Vec<Dim>> directions) const {
    for (const Vec<Dim>& direction : directions) {
      if (demand.normal.dot(direction) <= 0.0 && !demand.normal.isZero()) continue;
      const double end = std::min(options_.range, truth_.cast(demand.place + 1e-6 * direction, direction, options_.range).range);
      for (double t = options_.min_range; t < end; t += 0.5 * grid().spacing) {
        const Index<Dim> at = grid().nearest(demand.place + t * direction);
        if (!grid().inside(at)) break;
        const std::size_t node = grid().linear(at);
        if (is_place_[node] == 1 && measures(truth_, grid().position(node), demand, options_)) return node;
      }
    }
    return kNone;
  }

  /// Adds a place for each demand that too few candidates see, as far as those added before it do not see it.
  void add_missing_views() {
    const auto directions = fixed_directions<Dim>(reference_.options.rays);
    const auto wanted = static_cast<std::uint32_t>(options_.cover);
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < lines_.demands.size(); ++i)
      if (seers_[i] < wanted) missing.push_back(i);
    std::vector<std::size_t> view(missing.size(), kNone);
    parallel_for(missing.size(), 4, [&](std::size_t k) { view[k] = view_of(lines_.demands[missing[k]], directions); });
    const std::vector<std::uint32_t> before = seers_;
    for (std::size_t k = 0; k < missing.size(); ++k) {
      if (view[k] == kNone || is_place_[view[k]] != 1 || seers_[missing[k]] > before[missing[k]]) continue;
      add_candidate(view[k]);
      look_from_last();
    }
  }

  /// The same for one candidate, its demands in parallel.
  void look_from_last() {
    std::vector<char> seen(lines_.demands.size());
    parallel_for(seen.size(), 1024,
                 [&](std::size_t i) { seen[i] = measures(truth_, lines_.candidates.back(), lines_.demands[i], options_) ? 1 : 0; });
    auto& set = lines_.problem.sets.emplace_back();
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (seen[i]) set.push_back(static_cast<std::uint32_t>(i)), ++seers_[i];
  }

  void keep_what_is_seen() {
    std::vector<std::uint32_t> renamed(lines_.demands.size());
    std::vector<Demand<Dim>> kept;
    std::size_t walls = 0;
    for (std::size_t i = 0; i < lines_.demands.size(); ++i) {
      if (seers_[i] == 0) continue;
      renamed[i] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(lines_.demands[i]);
      walls += i < lines_.walls ? 1 : 0;
      lines_.problem.need.push_back(std::min(seers_[i], static_cast<std::uint32_t>(options_.cover)));
    }
    for (auto& set : lines_.problem.sets)
      for (std::uint32_t& i : set) i = renamed[i];
    lines_.demands = std::move(kept);
    lines_.walls = walls;
    lines_.problem.spare = static_cast<std::size_t>(std::floor((1.0 - options_.share) * static_cast<double>(lines_.demands.size()) + 1e-9));
  }

  static constexpr std::size_t kNone = ~std::size_t{0};

  const Scene<Dim>& scene_;
  const RayCaster<Dim>& truth_;
  const Reference<Dim>& reference_;
  const SurveyOptions& options_;
  Random random_;
  SightLines<Dim> lines_;
  std::vector<std::uint8_t> is_place_;  ///< Per node: 1 a scanner may stand there, 2 it is a candidate.
  std::vector<std::uint32_t> seers_;    ///< Candidates that see a demand.
};

}  // namespace

template <int Dim>
std::vector<Demand<Dim>> surface_demands(const Scene<Dim>& scene, std::int64_t count, std::uint64_t seed) {
  const double piece = mesh_content(scene.mesh) / static_cast<double>(count);
  Random random(seed);
  std::vector<Demand<Dim>> demands;
  double next = random.uniform() * piece, before = 0.0;
  for (std::size_t f = 0; f < scene.mesh.facets.size(); ++f) {
    const Vec<Dim> normal = facet_normal(scene.mesh, f);
    before += normal.norm();
    for (; next < before; next += piece) {
      const Vec<Dim> place = place_on(scene.mesh, f, random);
      if (!scene.domain.contains(place)) continue;
      demands.push_back({place, normal.normalized()});
      demands.push_back({place, -normal.normalized()});
    }
  }
  return demands;
}

template <int Dim>
bool measures(const RayCaster<Dim>& truth, const Vec<Dim>& from, const Demand<Dim>& demand, const SurveyOptions& options) {
  const Vec<Dim> ray = from - demand.place;
  const double range = ray.norm();
  if (range > options.range || range < options.min_range) return false;
  if (!demand.normal.isZero()) {
    const double cosine = ray.dot(demand.normal) / range;
    if (!(cosine > 0.0) || cosine < sin_cos(options.incidence)[1]) return false;
    double square = 1.0;
    for (int a = 1; a < Dim; ++a) square *= range * options.step;
    if (cosine < options.density * square) return false;
  }
  return in_sight(truth, from, demand.place);
}

template <int Dim>
SightLines<Dim> find_sight_lines(const Scene<Dim>& scene, const RayCaster<Dim>& truth, const Reference<Dim>& reference,
                                 const SurveyOptions& options) {
  return Builder<Dim>(scene, truth, reference, options).build();
}

#define VANTAGE_INSTANTIATE(D)                                                                           \
  template std::vector<Demand<D>> surface_demands<D>(const Scene<D>&, std::int64_t, std::uint64_t);      \
  template bool measures<D>(const RayCaster<D>&, const Vec<D>&, const Demand<D>&, const SurveyOptions&); \
  template SightLines<D> find_sight_lines<D>(const Scene<D>&, const RayCaster<D>&, const Reference<D>&, const SurveyOptions&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
