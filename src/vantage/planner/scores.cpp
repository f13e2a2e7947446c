// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>

#include "vantage/base/parallel.h"
#include "vantage/base/random.h"
#include "vantage/planner/baselines.h"
#include "vantage/planner/plain_sum.h"
#include "vantage/planner/planner.h"

namespace vantage {
namespace {

constexpr std::size_t kSectors = 24;  // A gap of 15 degrees without hits is none (bin_points.h).

}  // namespace

/// Those of the directions that a scan from the place is expected to say something of.
template <int Dim>
  requires SpatialDim<Dim>
std::vector<Vec<Dim>> Planner<Dim>::covered(const RayMarch<Dim>& march, const Vec<Dim>& place, std::span<const Vec<Dim>> directions) const {
  std::vector<Vec<Dim>> kept(directions.begin(), directions.end());
  if (!rule_.coverage) return kept;
  const Elevations& coverage = *rule_.coverage;
  std::erase_if(kept, [&](const Vec<Dim>& d) { return d[Dim - 1] < coverage.lowest || d[Dim - 1] > coverage.highest; });
  if (!coverage.by_hits) return kept;
  const std::vector<double> highest = march.highest_hits(place, kept, coverage.each_way ? kSectors : 1);
  std::erase_if(kept, [&](const Vec<Dim>& d) { return d[Dim - 1] > highest[sector_of<Dim>(d, highest.size())]; });
  return kept;
}

/// What a scan from there is expected to show, by directions that share the full sphere evenly.
template <int Dim>
  requires SpatialDim<Dim>
RaySums Planner<Dim>::look(const RayMarch<Dim>& march, const Vec<Dim>& place, std::span<const Vec<Dim>> directions) const {
  if (!rule_.coverage) return march.look(place, directions);
  const std::vector<Vec<Dim>> some = covered(march, place, directions);
  return some.empty() ? RaySums{} : march.look(place, some).scaled(static_cast<double>(some.size()) / static_cast<double>(directions.size()));
}

template <int Dim>
  requires SpatialDim<Dim>
double Planner<Dim>::mix(const RaySums& sums) const {
  const auto term = [](double weight, double value, double largest) { return largest > 0.0 ? weight * value / largest : 0.0; };
  return term(options_.volume_weight, sums.volume, scale_.volume) + term(options_.solid_angle_weight, sums.solid_angle, scale_.solid_angle) +
         term(options_.area_weight, sums.area, scale_.area);
}

/// What the way there leaves of E.
template <int Dim>
  requires SpatialDim<Dim>
double Planner<Dim>::after_travel(std::size_t node) const {
  if (walk_.values.empty()) return 1.0;
  const double share = 1.0 + static_cast<double>(walk_[node]) / (options_.speed * options_.scan_time);
  return std::isfinite(share) ? inverse_power(share, options_.travel_weight) : 0.0;
}

template <int Dim>
  requires SpatialDim<Dim>
void Planner<Dim>::set_scale(std::span<const Scored> scored) {
  scale_ = {};
  for (const Scored& s : scored) {
    scale_.volume = std::max(scale_.volume, s.sums.volume);
    scale_.solid_angle = std::max(scale_.solid_angle, s.sums.solid_angle);
    scale_.area = std::max(scale_.area, s.sums.area);
  }
}

template <int Dim>
  requires SpatialDim<Dim>
auto Planner<Dim>::score_by_rays(const BeliefView<Dim>& view, std::span<const std::size_t> nodes) -> std::vector<Scored> {
  const RayMarch<Dim> march = rays(view);
  const std::uint64_t turn = seed_ * 1000003 + visited_.size();
  std::vector<Scored> scored(nodes.size());
  const auto look_at = [&](std::span<Scored> some, std::int64_t count) {
    const std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(count), turn + static_cast<std::uint64_t>(count));
    parallel_for(some.size(), 1, [&](std::size_t i) { some[i].sums = look(march, view.window().position(some[i].node), directions); });
  };
  const auto rank = [&] {
    set_scale(scored);
    for (Scored& s : scored) s.score = mix(s.sums) * after_travel(s.node);
    std::sort(scored.begin(), scored.end(),
              [](const Scored& a, const Scored& b) { return std::tuple(-a.score, a.node) < std::tuple(-b.score, b.node); });
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) scored[i].node = nodes[i];
  look_at(scored, options_.rays);
  rank();
  const std::size_t best = std::min<std::size_t>(scored.size(), static_cast<std::size_t>(options_.refine));
  look_at(std::span(scored).first(best), options_.refine_rays);
  // The rest keeps its first look; only those looked at twice may win.
  std::vector<Scored> rest(scored.begin() + static_cast<std::ptrdiff_t>(best), scored.end());
  scored.resize(best);
  rank();
  for (Scored& s : rest) s.score = mix(s.sums) * after_travel(s.node);
  scored.insert(scored.end(), rest.begin(), rest.end());
  return scored;
}

template <int Dim>
  requires SpatialDim<Dim>
auto Planner<Dim>::score_by_boundary(const BeliefView<Dim>& view, std::span<const std::size_t> nodes) const -> std::vector<Scored> {
  const RayMarch<Dim> march = rays(view);
  const std::vector<BoundaryElement<Dim>> elements = boundary_elements(view, opening_.faces(), options_);
  const std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(options_.rays), seed_ * 1000003 + visited_.size());
  std::vector<Scored> scored(nodes.size());
  const BoundarySum<Dim> sum(elements, march, options_);
  parallel_for(nodes.size(), 1, [&](std::size_t i) {
    scored[i].node = nodes[i];
    scored[i].score = sum.at(view.window().position(nodes[i])) * after_travel(nodes[i]);
  });
  std::sort(scored.begin(), scored.end(),
            [](const Scored& a, const Scored& b) { return std::tuple(-a.score, a.node) < std::tuple(-b.score, b.node); });
  // The end of the run is judged by expected volume whatever the metric (method.md Sec. 7): that of the best few.
  parallel_for(std::min<std::size_t>(scored.size(), 64), 1,
               [&](std::size_t i) { scored[i].sums = look(march, view.window().position(scored[i].node), directions); });
  return scored;
}

template <int Dim>
  requires SpatialDim<Dim>
auto Planner<Dim>::score_by_baseline(const BeliefView<Dim>& view, std::span<const std::size_t> nodes, std::span<const std::size_t> medial)
    -> std::vector<Scored> {
  using Metric = PlannerOptions::Metric;
  const RayMarch<Dim> march = rays(view);
  const std::vector<BoundaryFace<Dim>> frontier = frontier_faces(view, opening_.faces());
  const std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(options_.rays), seed_ * 1000003 + visited_.size());
  std::vector<Scored> scored;
  for (const std::size_t node : nodes) scored.push_back({node, {}, 0.0});
  if (options_.metric == Metric::random && !medial.empty()) scored.push_back({medial[Random(seed_, visited_.size()).below(medial.size())], {}, 1.0});
  if (options_.metric == Metric::nearest) {
    const double h = view.window().spacing;
    const auto places = frontier_places<Dim>(reachable_, frontier, visited_, options_.clearance + 1.5 * h);
    if (places.empty()) return {};
    scored.push_back({places[0].node, {}, 1.0 / (places[0].walk + h)});
  }
  parallel_for(scored.size(), 1, [&](std::size_t i) {
    const Vec<Dim> z = view.window().position(scored[i].node);
    scored[i].sums = look(march, z, directions);  // The end of the run is judged by expected volume whatever the metric.
    if (options_.metric == Metric::count) scored[i].score = frontier_count<Dim>(frontier, march, z, max_range_) * after_travel(scored[i].node);
  });
  set_scale(scored);
  return scored;
}

template <int Dim>
  requires SpatialDim<Dim>
auto Planner<Dim>::score_by_optimism(const BeliefView<Dim>& view, std::span<const std::size_t> medial) -> std::vector<Scored> {
  const std::size_t most_blocks = static_cast<std::size_t>(options_.candidates) * 64;
  if (!pool_) pool_.emplace(view.window(), most_blocks);
  pool_->offer(medial);
  // The same directions at every step: gains only fall.
  const std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(options_.rays), seed_);
  std::vector<Scored> scored;
  for (const auto& gain : pool_->best(rays(view), directions, reachable_, visited_)) {
    scored.push_back({gain.node, {}, gain.volume});
    scored.back().sums.volume = gain.volume;
  }
  set_scale(scored);
  return scored;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                  \
  template std::vector<Vec<D>> Planner<D>::covered(const RayMarch<D>&, const Vec<D>&, std::span<const Vec<D>>) const;           \
  template RaySums Planner<D>::look(const RayMarch<D>&, const Vec<D>&, std::span<const Vec<D>>) const;                          \
  template double Planner<D>::mix(const RaySums&) const;                                                                        \
  template double Planner<D>::after_travel(std::size_t) const;                                                                  \
  template void Planner<D>::set_scale(std::span<const Scored>);                                                                 \
  template auto Planner<D>::score_by_rays(const BeliefView<D>&, std::span<const std::size_t>) -> std::vector<Scored>;           \
  template auto Planner<D>::score_by_boundary(const BeliefView<D>&, std::span<const std::size_t>) const -> std::vector<Scored>; \
  template auto Planner<D>::score_by_baseline(const BeliefView<D>&, std::span<const std::size_t>, std::span<const std::size_t>) \
      -> std::vector<Scored>;                                                                                                   \
  template auto Planner<D>::score_by_optimism(const BeliefView<D>&, std::span<const std::size_t>) -> std::vector<Scored>;
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
