// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/field/fast_marching.h"
#include "vantage/planner/candidates.h"
#include "vantage/planner/plain_sum.h"
#include "vantage/planner/safe_path.h"

namespace vantage {
namespace {

constexpr double kMatters = 0.005;  // Of the seen volume: of last looks that may show so much there may be twice as many.

/// w of every node, from the boxes of PlannerOptions::weights and what the rule holds it worth; empty if there is neither.
template <int Dim>
Field<Dim> weight_field(const Grid<Dim>& window, const std::vector<double>& weights, const std::function<double(const Vec<Dim>&)>& worth) {
  if (weights.empty() && !worth) return {};
  Field<Dim> field(window, 1.0F);
  for (std::size_t i = 0; i < field.values.size(); ++i)
    for (auto box = weights.begin(); box != weights.end(); box += 2 * Dim + 1) {
      const Box<Dim> region{Eigen::Map<const Vec<Dim>>(&box[0]), Eigen::Map<const Vec<Dim>>(&box[Dim])};
      if (region.contains(window.position(i))) field[i] = static_cast<float>(box[2 * Dim]);
    }
  if (worth) parallel_for(field.values.size(), 1024, [&](std::size_t i) { field[i] *= static_cast<float>(worth(window.position(i))); });
  return field;
}

template <int Dim>
void check_weights(const std::vector<double>& weights) {
  constexpr std::size_t kNumbers = 2 * Dim + 1;
  require(weights.size() % kNumbers == 0,
          fmt::format("planner.weights: {} numbers: must be {} a box: low corner, high corner [m], weight", weights.size(), kNumbers));
  for (std::size_t i = 0; i < weights.size(); ++i) {
    require(std::isfinite(weights[i]), fmt::format("planner.weights: {}: must be finite", weights[i]));
    if (i % kNumbers == kNumbers - 1)
      require(weights[i] >= 0.0 && weights[i] <= 1e6, fmt::format("planner.weights: weight {}: must be 0 .. 1e+06", weights[i]));
  }
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Planner<Dim>::Planner(const PlannerOptions& options, double max_range, std::uint64_t seed)
    : options_(options),
      max_range_(max_range),
      seed_(seed),
      opening_(options.learned ? OpeningModel<Dim>::Rule::learned : OpeningModel<Dim>::Rule::masks) {
  check_options(options, "planner");
  check_weights<Dim>(options.weights);
  require(options.travel_weight == 0.0 || options.metric != PlannerOptions::Metric::optimistic,
          fmt::format("planner.travel_weight = {:g}: must be 0 with planner.metric = optimistic, whose bounds know no way", options.travel_weight));
}

template <int Dim>
  requires SpatialDim<Dim>
RayMarch<Dim> Planner<Dim>::rays(const BeliefView<Dim>& view) const {
  return rays(view, weight_.values.empty() ? nullptr : &weight_);
}

template <int Dim>
  requires SpatialDim<Dim>
RayMarch<Dim> Planner<Dim>::rays(const BeliefView<Dim>& view, const Field<Dim>* weight) const {
  return RayMarch<Dim>(view, opening_.openness(), {opacity_, max_range_, options_.tau_power, weight, &grid_});
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<std::size_t> Planner<Dim>::candidates(const BeliefView<Dim>& view) const {
  if (!rule_.all) return medial_nodes<Dim>(view, reachable_, visited_, options_);
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < reachable_.values.size(); ++i) {
    const Vec<Dim> p = view.window().position(i);
    const auto near = [&](const Vec<Dim>& v) { return (p - v).norm() < 2.0 * view.window().spacing; };
    if (reachable_[i] == 0 || std::any_of(visited_.begin(), visited_.end(), near)) continue;
    const Index<Dim> nearest = view.window().nearest(place_at(view, i));
    if (nearest == view.window().local(i) || !view.window().inside(nearest) || reachable_.at(nearest) == 0) nodes.push_back(i);
  }
  return nodes;
}

/// Where a scanner stands that is put at a node.
template <int Dim>
  requires SpatialDim<Dim>
Vec<Dim> Planner<Dim>::place_at(const BeliefView<Dim>& view, std::size_t node) const {
  const Vec<Dim> p = view.window().position(node);
  return rule_.stand ? rule_.stand(view, p) : p;
}

/// The reachable node nearest to a place; kNoNode if nothing is reachable.
template <int Dim>
  requires SpatialDim<Dim>
std::size_t Planner<Dim>::nearest_place(const Vec<Dim>& place) const {
  const Grid<Dim>& grid = reachable_.window;
  std::size_t nearest = kNoNode;
  double least = kInfinity;
  for (std::size_t i = 0; i < reachable_.values.size(); ++i) {
    const double distance = reachable_[i] != 0 ? (grid.position(i) - place).squaredNorm() : kInfinity;
    if (distance < least) least = distance, nearest = i;
  }
  return nearest;
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<Vec<Dim>> Planner<Dim>::path_to(std::size_t node) const {
  return safe_path(reachable_, first_, node, visited_.back());
}

template <int Dim>
  requires SpatialDim<Dim>
void Planner<Dim>::go_to(const BeliefView<Dim>& view, std::size_t node, Decision<Dim>& decision) const {
  decision.position = place_at(view, node);
  decision.path = path_to(node);
  if (decision.path.back() != decision.position) decision.path.push_back(decision.position);
}

template <int Dim>
  requires SpatialDim<Dim>
typename Decision<Dim>::End Planner<Dim>::end_of(const Decision<Dim>& decision, double seen_volume) {
  using End = typename Decision<Dim>::End;
  if (!decision.found) return opening_.faces().empty() ? End::nothing_can_open : End::unreachable;
  below_ = decision.expected_volume < options_.stop_volume * seen_volume ? below_ + 1 : 0;
  if (!(decision.expected_volume > 0.0)) return End::nothing_can_open;
  if (below_ >= 2) return End::below_threshold;
  return idle_ >= options_.idle_limit ? End::idle : End::none;
}

/// Ties go to the nearer, then to the smaller index.
template <int Dim>
  requires SpatialDim<Dim>
auto Planner<Dim>::best_of(std::span<const Scored> scored, const Vec<Dim>& here) const -> const Scored& {
  const auto rank = [&](const Scored& s) { return std::tuple(-s.score, (reachable_.window.position(s.node) - here).squaredNorm(), s.node); };
  return *std::min_element(scored.begin(), scored.end(), [&](const Scored& a, const Scored& b) { return rank(a) < rank(b); });
}

template <int Dim>
  requires SpatialDim<Dim>
Decision<Dim> Planner<Dim>::choose(const BeliefView<Dim>& view, const Vec<Dim>& here, double new_volume) {
  using Metric = PlannerOptions::Metric;
  visited_.push_back(here);
  if (weight_.values.empty()) weight_ = weight_field<Dim>(view.window(), options_.weights, rule_.worth);
  MarchGrid<Dim> grid(view.state);
  if (pool_ && !grid.grown_from(grid_)) pool_->forget();
  grid_ = std::move(grid);
  opening_.update(view, here, max_range_, &grid_);
  opacity_ = options_.lambda_factor * measured_opacity(view);
  reachable_ = rule_.places ? rule_.places(view, here) : reachable_nodes(view, here, options_.clearance);
  // By a rule we may stand off the places ourselves: first to the nearest of them.
  first_ = rule_.places ? nearest_place(here) : first_node<Dim>(view, here, [&](std::size_t node) { return reachable_[node] != 0; });
  if (options_.travel_weight > 0.0 && first_ != kNoNode) walk_ = fast_march<Dim>(reachable_, std::array{Seed{first_, 0.0F}});

  auto seen_volume = static_cast<double>(seen_nodes(view));
  for (int a = 0; a < Dim; ++a) seen_volume *= view.window().spacing;
  idle_ = new_volume < 1e-5 * seen_volume ? idle_ + 1 : 0;

  const std::vector<std::size_t> medial = candidates(view);
  const std::size_t limit = static_cast<std::size_t>(options_.candidates) * (4 - Dim);
  const std::uint64_t turn = seed_ * 7919 + visited_.size();
  const std::vector<std::size_t> nodes = choose_candidates<Dim>(medial, opening_.faces(), rays(view), view.window(), limit, turn);
  const std::vector<Scored> scored = options_.metric == Metric::ray          ? score_by_rays(view, nodes)
                                     : options_.metric == Metric::boundary   ? score_by_boundary(view, nodes)
                                     : options_.metric == Metric::optimistic ? score_by_optimism(view, medial)
                                                                             : score_by_baseline(view, nodes, medial);

  Decision<Dim> decision;
  decision.candidates = static_cast<std::int64_t>(scored.size());
  for (const Scored& s : scored) decision.scored.emplace_back(s.node, static_cast<float>(s.score));
  last_.clear();
  if (!scored.empty()) {
    const Scored& best = options_.look_ahead > 0 && options_.metric == Metric::ray ? first_of_best_pair(view, scored) : best_of(scored, here);
    decision.found = true;
    decision.score = best.score;
    decision.area = best.sums.area;
    for (const Scored& s : scored) decision.expected_volume = std::max(decision.expected_volume, s.sums.volume);
    go_to(view, best.node, decision);
    last_.emplace_back(best.node, best.score);
    for (const Scored& s : scored)
      if (s.node != best.node) last_.emplace_back(s.node, s.score);
  }
  decision.end = end_of(decision, seen_volume);
  decision.found = decision.end == Decision<Dim>::End::none;
  last_look_ = squeezed_ = {};
  if (new_volume >= options_.stop_volume * seen_volume) last_looks_ = 0;
  if (!decision.found && decision.end != Decision<Dim>::End::idle) look_again(view, decision, seen_volume);
  return decision;
}

/// Nothing much is expected any more: is there a face nobody has looked at, and a place that sees it?
template <int Dim>
  requires SpatialDim<Dim>
void Planner<Dim>::look_again(const BeliefView<Dim>& view, Decision<Dim>& decision, double seen_volume) {
  std::optional<RayCaster<Dim>> surface;
  if (surface_) surface.emplace(patch_mesh<Dim>(surface_(), 0.3 * view.window().spacing));
  const Field<Dim>* weight = weight_.values.empty() ? nullptr : &weight_;
  const Ground<Dim> ground{reachable_, visited_, max_range_, surface ? &*surface : nullptr, true, weight};
  last_look_ = looks_.look(view, opening_.faces(), ground);
  const std::int64_t limit = last_look_.volume >= kMatters * seen_volume ? 2 * options_.last_looks : options_.last_looks;
  const std::int64_t others = static_cast<std::int64_t>(visited_.size()) - all_last_looks_;
  if (last_look_.place && last_looks_ < limit && all_last_looks_ < options_.last_looks + others / 2) {
    ++last_looks_;
    ++all_last_looks_;
    looks_.answer(view, opening_.faces(), ground, *last_look_.place);
    decision.found = true;
    decision.end = Decision<Dim>::End::none;
    go_to(view, *last_look_.place, decision);
    return;
  }
  const Field<Dim, std::uint8_t> squeezed = squeezed_nodes(view, reachable_, options_.clearance);
  squeezed_ = looks_.look(view, opening_.faces(), {squeezed, visited_, max_range_, ground.surface, false, weight});
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<double> Planner<Dim>::evaluate(const BeliefView<Dim>& view, std::span<const Vec<Dim>> places) const {
  const RayMarch<Dim> march = rays(view);
  const bool by_rays = options_.metric != PlannerOptions::Metric::boundary;
  const std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(options_.rays / 2), seed_);
  const std::vector<BoundaryElement<Dim>> elements =
      by_rays ? std::vector<BoundaryElement<Dim>>{} : boundary_elements(view, opening_.faces(), options_);
  const BoundarySum<Dim> sum(elements, march, options_);
  std::vector<double> values(places.size(), std::numeric_limits<double>::quiet_NaN());
  parallel_for(places.size(), 1, [&](std::size_t i) {
    const Index<Dim> node = view.window().nearest(places[i]);
    if (!view.window().inside(node) || !view.seen(view.window().linear(node))) return;
    values[i] = by_rays ? mix(look(march, places[i], directions)) : sum.at(places[i]);
  });
  return values;
}

template <int Dim>
  requires SpatialDim<Dim>
Verdict<Dim> Planner<Dim>::assess(const BeliefView<Dim>& view) const {
  double least = options_.report_volume;
  if (least == 0.0) {
    least = 1.0;
    for (int a = 0; a < Dim; ++a) least *= 3.0 * view.window().spacing;
  }
  return vantage::assess<Dim>(view, opening_.faces(), reachable_, {opacity_, max_range_, least, &last_look_, &squeezed_, &glimpses_});
}

template class Planner<2>;
template class Planner<3>;

}  // namespace vantage
