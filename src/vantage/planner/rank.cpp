// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "vantage/base/parallel.h"
#include "vantage/planner/planner.h"

namespace vantage {
namespace {

constexpr std::int64_t kRays = 4000;  // Of a look at a place (2D: a quarter).
constexpr double kOpen = 0.05;        // A boundary that opens with less is no surface that could be registered, nor much to see.
constexpr double kFaint = 0.02;       // What is shown with less counts as hidden.
constexpr std::size_t kNever = ~std::size_t{0};

/// e^-x for a small x >= 0, by + * / alone.
double fading(double x) {
  double value = 1.0 / (1.0 + x / 64.0);
  for (int k = 0; k < 6; ++k) value *= value;
  return value;
}

/// What a scan from a place is expected to show, by straight lines through the lattice.
template <int Dim>
class Preview {
 public:
  Preview(const BeliefView<Dim>& view, const Field<Dim>& openness, double opacity, double range)
      : view_(view), openness_(openness), grid_(view.window()), fade_(fading(0.5 * opacity * grid_.spacing)), range_(range) {}

  /// Probability that the unseen node is shown to `from`: that the boundary opens, times what the unseen lets through; 0 behind a known surface.
  [[nodiscard]] double shows(const Vec<Dim>& from, std::size_t node) const {
    const Vec<Dim> offset = grid_.position(node) - from;
    const double distance = offset.norm();
    if (distance > range_) return 0.0;
    double open = -1.0, through = 1.0;
    bool obstacle = false;
    walk(from, offset / distance, distance - 0.5 * grid_.spacing, [&](std::size_t i) {
      const NodeState state = view_.state[i];
      obstacle = state == NodeState::obstacle;
      if (obstacle) return false;
      if (state == NodeState::unseen) {
        open = std::max(open, static_cast<double>(openness_[i]));
        through *= fade_;
      }
      return through > kFaint;
    });
    if (obstacle || through <= kFaint) return 0.0;
    return std::max(open < 0.0 ? static_cast<double>(openness_[node]) : open, 0.0) * through;
  }

  /// Lessens what is left of every unseen node by what a scan from `place` will show.
  void take(const Vec<Dim>& place, Field<Dim>& left) const {
    parallel_for(grid_.size(), 1024, [&](std::size_t i) {
      if (view_.state[i] == NodeState::unseen && left[i] > 0.0F) left[i] *= static_cast<float>(1.0 - shows(place, i));
    });
  }

  /// Share of known surface in all that is in view: surface and boundary that may open.
  [[nodiscard]] double overlap(const Vec<Dim>& from, std::span<const Vec<Dim>> directions) const {
    std::int64_t known = 0, open = 0;
    for (const Vec<Dim>& d : directions)
      walk(from, d, range_, [&](std::size_t i) {
        if (view_.state[i] == NodeState::seen) return true;
        known += view_.state[i] == NodeState::obstacle ? 1 : 0;
        open += view_.state[i] == NodeState::unseen && static_cast<double>(openness_[i]) > kOpen ? 1 : 0;
        return false;
      });
    return known + open > 0 ? static_cast<double>(known) / static_cast<double>(known + open) : 0.0;
  }

 private:
  /// Calls visit(node) every half cell, from one cell off the start on, while it returns true.
  template <class Visit>
  void walk(const Vec<Dim>& from, const Vec<Dim>& direction, double length, Visit&& visit) const {
    const Vec<Dim> start = from / grid_.spacing, step = 0.5 * direction;
    const auto samples = static_cast<int>(2.0 * length / grid_.spacing);
    for (int k = 2; k < samples; ++k) {
      const Vec<Dim> p = start + static_cast<double>(k) * step;
      Index<Dim> node;
      for (int a = 0; a < Dim; ++a) node[a] = static_cast<std::int32_t>(std::floor(p[a] + 0.5)) - grid_.first[a];
      if (!grid_.inside(node) || !visit(grid_.linear(node))) return;
    }
  }

  const BeliefView<Dim>& view_;
  const Field<Dim>& openness_;
  Grid<Dim> grid_;
  double fade_, range_;
};

/// A candidate and the score it had when so many places had been taken.
struct Entry {
  double score = 0.0;
  std::size_t place = 0;
  std::size_t taken = 0;
  [[nodiscard]] bool operator<(const Entry& other) const { return std::tuple(score, other.place) < std::tuple(other.score, place); }
};

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
std::vector<Vec<Dim>> Planner<Dim>::way_to(const Vec<Dim>& place) const {
  const Vec<Dim>& here = visited_.back();
  const std::size_t node = nearest_place(place);
  if (node == kNoNode) return {here, place};
  std::vector<Vec<Dim>> path = path_to(node, here);
  if (reachable_.window.position(node) != place) path.push_back(place);
  return path;
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<RankedPlace<Dim>> Planner<Dim>::rank(const BeliefView<Dim>& view, const RankRequest<Dim>& request) const {
  const Grid<Dim>& grid = view.window();
  const Preview<Dim> preview(view, opening_.openness(), opacity_, max_range_);
  const std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(kRays), seed_ * 1000003 + visited_.size());
  Field<Dim> left = weight_.values.empty() ? Field<Dim>(grid, 1.0F) : weight_;
  const auto take = [&](const Vec<Dim>& place) { preview.take(place, left); };
  for (const Vec<Dim>& place : request.planned) take(place);

  double least = options_.stop_volume * static_cast<double>(seen_nodes(view));
  for (int a = 0; a < Dim; ++a) least *= grid.spacing;
  std::priority_queue<Entry> queue;
  std::vector<Vec<Dim>> places = request.among;
  if (places.empty())
    for (const auto& [node, score] : last_) {
      queue.push({score, places.size(), kNever});
      places.push_back(grid.position(node));
    }
  else
    for (std::size_t k = 0; k < places.size(); ++k) queue.push({kInfinity, k, kNever});
  const bool stands = request.planned.empty() && request.among.empty() && !last_.empty();
  if (stands) queue.push({kInfinity, 0, 0});  // The decision is the first.
  std::vector<Vec<Dim>> taken = request.planned;
  std::vector<RankedPlace<Dim>> ranked;
  while (static_cast<std::int64_t>(ranked.size()) < request.count && !queue.empty()) {
    const Entry entry = queue.top();
    queue.pop();
    const Vec<Dim>& place = places[entry.place];
    const bool close =
        std::any_of(taken.begin(), taken.end(), [&](const Vec<Dim>& p) { return (p - place).norm() < std::max(request.apart, 0.5 * grid.spacing); });
    if (close) continue;
    const RaySums sums = rays(view, &left).look(place, directions);
    if (entry.taken != ranked.size()) {  // Scores only fall as places are taken: the first that keeps its place is the best.
      const double way = request.among.empty() ? after_travel(grid.linear(grid.nearest(place))) : 1.0;  // As in the first scores.
      queue.push({mix(sums) * way, entry.place, ranked.size()});
      continue;
    }
    const double overlap = preview.overlap(place, directions);
    if (sums.volume < least || overlap < request.overlap) continue;
    const RaySums alone = rays(view, nullptr).look(place, directions);
    const double score = entry.score < kInfinity ? entry.score : last_.front().second;
    ranked.push_back({place, score, alone.volume, sums.volume, alone.area, overlap, way_to(place)});
    taken.push_back(place);
    if (static_cast<std::int64_t>(ranked.size()) < request.count) take(place);
  }
  return ranked;
}

/// Two-step look-ahead: of all pairs of a few good places the one that is expected to show most together; its better half.
template <int Dim>
  requires SpatialDim<Dim>
auto Planner<Dim>::first_of_best_pair(const BeliefView<Dim>& view, std::span<const Scored> scored) const -> const Scored& {
  const Grid<Dim>& grid = view.window();
  const Preview<Dim> preview(view, opening_.openness(), opacity_, max_range_);
  const std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(kRays), seed_ * 1000003 + visited_.size());
  const std::size_t count = std::min(scored.size(), static_cast<std::size_t>(options_.look_ahead));
  std::size_t first = 0;
  double most = -1.0;
  for (std::size_t i = 0; i < count; ++i) {  // Best first: `i` is the better half.
    Field<Dim> left = weight_.values.empty() ? Field<Dim>(grid, 1.0F) : weight_;
    preview.take(grid.position(scored[i].node), left);
    const RayMarch<Dim> march = rays(view, &left);
    std::vector<double> both(count - i, scored[i].score);
    parallel_for(both.size() - 1, 1, [&](std::size_t k) {
      const Scored& second = scored[i + 1 + k];
      both[k] += mix(march.look(grid.position(second.node), directions)) * after_travel(second.node);
    });
    const double best = *std::max_element(both.begin(), both.end());
    if (best > most) most = best, first = i;
  }
  return scored[first];
}

#define VANTAGE_INSTANTIATE(D)                                                                              \
  template std::vector<RankedPlace<D>> Planner<D>::rank(const BeliefView<D>&, const RankRequest<D>&) const; \
  template auto Planner<D>::first_of_best_pair(const BeliefView<D>&, std::span<const Scored>) const -> const Scored&;
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
