// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "vantage/base/parallel.h"
#include "vantage/planner/planner.h"
#include "vantage/planner/preview.h"

namespace vantage {
namespace {

constexpr std::int64_t kRays = 4000;  // Of a look at a place (2D: a quarter).
constexpr std::size_t kNever = ~std::size_t{0};

/// Known surface that waits for a better look.
template <int Dim>
class Mending {
 public:
  Mending(const RankRequest<Dim>& request, const RayMarch<Dim>& march, double range)
      : pieces_(request.mend), left_(pieces_.size(), 1), least_(request.least_cosine), range_(range), march_(march) {}

  [[nodiscard]] bool any() const { return !pieces_.empty(); }
  /// What a scan from there would show well and no taken place does [m^(Dim-1)].
  [[nodiscard]] double area(const Vec<Dim>& from) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (left_[i] != 0 && shows(from, pieces_[i])) sum += pieces_[i].area;
    return sum;
  }
  void take(const Vec<Dim>& from) {
    parallel_for(pieces_.size(), 256, [&](std::size_t i) {
      if (left_[i] != 0 && shows(from, pieces_[i])) left_[i] = 0;
    });
  }
  /// Of the nodes that are 1 and of every block of four of them along each axis one, those that show most.
  [[nodiscard]] std::vector<Vec<Dim>> viewers(const Field<Dim, std::uint8_t>& nodes) const {
    constexpr std::size_t kMost = 200;
    Grid<Dim> blocks = nodes.window;
    blocks.extent = (blocks.extent.array() + 3) / 4;
    std::vector<std::uint8_t> taken(blocks.size());
    std::vector<Vec<Dim>> places;
    for (std::size_t i = 0; i < nodes.values.size(); ++i) {
      if (nodes[i] == 0) continue;
      std::uint8_t& of_block = taken[blocks.linear(nodes.window.local(i) / 4)];
      if (of_block == 0) places.push_back(nodes.window.position(i));
      of_block = 1;
    }
    std::vector<std::pair<double, std::size_t>> order(places.size());
    parallel_for(places.size(), 1, [&](std::size_t i) { order[i] = {-area(places[i]), i}; });
    std::sort(order.begin(), order.end());
    std::vector<Vec<Dim>> best;
    for (std::size_t k = 0; k < std::min(kMost, order.size()) && order[k].first < 0.0; ++k) best.push_back(places[order[k].second]);
    return best;
  }

 private:
  [[nodiscard]] bool shows(const Vec<Dim>& from, const SurfacePiece<Dim>& piece) const {
    const Vec<Dim> offset = from - piece.center;
    const double distance = offset.norm(), along = offset.dot(piece.normal);
    if (distance > range_ || std::abs(along) < least_ * distance) return false;
    // The pieces lie in cells that are no free space: to before them.
    return march_.line_of_sight(from, piece.center, 2.0 * march_.spacing());
  }

  const std::vector<SurfacePiece<Dim>>& pieces_;
  std::vector<std::uint8_t> left_;
  double least_, range_;
  const RayMarch<Dim>& march_;
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
  const std::size_t node = nearest_place(place);
  if (node == kNoNode) return {visited_.back(), place};
  std::vector<Vec<Dim>> path = path_to(node);
  if (reachable_.window.position(node) != place) path.push_back(place);
  return path;
}

/// What rank() asks of places.
template <int Dim>
  requires SpatialDim<Dim>
struct Planner<Dim>::Ranking {
  const Planner& planner;
  const BeliefView<Dim>& view;
  const RankRequest<Dim>& request;
  Facing<Dim> facing{planner.opening_.faces(), request.least_cosine};
  Preview<Dim> preview{view, planner.opening_.openness(), {planner.opacity_, planner.max_range_}, facing};
  RayMarch<Dim> clear = planner.rays(view, nullptr);
  Mending<Dim> mending{request, clear, planner.max_range_};
  std::vector<Vec<Dim>> directions = spread_directions<Dim>(rays_in<Dim>(kRays), planner.seed_ * 1000003 + planner.visited_.size());
  Field<Dim> unshown{view.window(), 1.0F};  // Share of each node that no taken place shows.
  Field<Dim> left = planner.weight_;        // The same times w; empty: w is 1.
  double most_mended = 0.0;

  void take(const Vec<Dim>& place) {
    preview.take(place, unshown);
    for (std::size_t i = 0; i < left.values.size(); ++i) left[i] = planner.weight_[i] * unshown[i];
    mending.take(place);
  }
  [[nodiscard]] RaySums look(const Vec<Dim>& place, const Field<Dim>* weight) const {
    const RayMarch<Dim> march = planner.rays(view, weight);
    if (facing.any()) return planner.look(march, place, directions);
    const std::vector<Vec<Dim>> some = preview.frontal(place, planner.covered(march, place, directions));
    return some.empty() ? RaySums{} : march.look(place, some).scaled(static_cast<double>(some.size()) / static_cast<double>(directions.size()));
  }
  [[nodiscard]] const Field<Dim>* weight() const { return left.values.empty() ? &unshown : &left; }
  [[nodiscard]] double score(const RaySums& sums, double mended) const {
    const double most = std::max(planner.scale_.area, most_mended);
    return planner.mix(sums) + (most > 0.0 ? mended / most : 0.0);
  }
};

template <int Dim>
  requires SpatialDim<Dim>
std::vector<RankedPlace<Dim>> Planner<Dim>::rank(const BeliefView<Dim>& view, const RankRequest<Dim>& request) const {
  const Grid<Dim>& grid = view.window();
  Ranking ranking{*this, view, request};
  for (const Vec<Dim>& place : request.planned) ranking.take(place);

  double least = options_.stop_volume * static_cast<double>(seen_nodes(view)), least_mended = 1.0;
  for (int a = 0; a < Dim; ++a) least *= grid.spacing, least_mended *= a > 0 ? 3.0 * grid.spacing : 1.0;
  const bool limited = request.least_cosine > 0.0;
  std::priority_queue<Entry> queue;
  std::vector<Vec<Dim>> places = request.among;
  if (places.empty())
    for (const auto& [node, score] : last_) {
      queue.push({limited ? kInfinity : score, places.size(), kNever});
      places.push_back(place_at(view, node));
    }
  else
    for (std::size_t k = 0; k < places.size(); ++k) queue.push({kInfinity, k, kNever});
  if (request.among.empty() && ranking.mending.any())
    for (const Vec<Dim>& place : ranking.mending.viewers(reachable_)) {
      queue.push({kInfinity, places.size(), kNever});
      places.push_back(place_at(view, grid.linear(grid.nearest(place))));
    }
  std::vector<double> mended(places.size());
  if (ranking.mending.any()) parallel_for(places.size(), 1, [&](std::size_t k) { mended[k] = ranking.mending.area(places[k]); });
  for (const double area : mended) ranking.most_mended = std::max(ranking.most_mended, area);
  const bool stands = request.planned.empty() && request.among.empty() && !last_.empty() && !limited;
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
    const RaySums sums = ranking.look(place, ranking.weight());
    const double better = ranking.mending.any() ? ranking.mending.area(place) : 0.0;
    if (entry.taken != ranked.size()) {  // Scores only fall as places are taken: the first that keeps its place is the best.
      const double way = request.among.empty() ? after_travel(grid.linear(grid.nearest(place))) : 1.0;  // As in the first scores.
      queue.push({ranking.score(sums, better) * way, entry.place, ranked.size()});
      continue;
    }
    const double overlap = ranking.preview.overlap(place, ranking.directions);
    if ((sums.volume < least && better < least_mended) || overlap < request.overlap) continue;
    const RaySums alone = ranking.look(place, nullptr), added = ranking.look(place, &ranking.unshown);
    const double score = entry.score < kInfinity ? entry.score : last_.front().second;
    ranked.push_back({place, score, alone.volume, added.volume, alone.area, overlap, way_to(place), better});
    taken.push_back(place);
    if (static_cast<std::int64_t>(ranked.size()) < request.count) ranking.take(place);
  }
  return ranked;
}

/// Two-step look-ahead: of all pairs of a few good places the one that is expected to show most together; its better half.
template <int Dim>
  requires SpatialDim<Dim>
auto Planner<Dim>::first_of_best_pair(const BeliefView<Dim>& view, std::span<const Scored> scored) const -> const Scored& {
  const Grid<Dim>& grid = view.window();
  const Facing<Dim> facing({}, 0.0);
  const Preview<Dim> preview(view, opening_.openness(), {opacity_, max_range_}, facing);
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
      both[k] += mix(look(march, grid.position(second.node), directions)) * after_travel(second.node);
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
