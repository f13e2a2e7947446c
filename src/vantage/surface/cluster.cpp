// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/cluster.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr std::size_t kSample = 128;  ///< More points than these are represented by a spread sample.
constexpr int kRounds = 4;
constexpr double kProgress = 0.8;        ///< A round that thins the pieces by less is the last.
constexpr std::size_t kQueries = 48;     ///< Places asked for a hole.
constexpr double kClearHole = 1.1;       ///< The pieces of a sample are not quite those of all: so much wider than the limit must a hole be.
constexpr double kOutside = 1.0 / 64.0;  ///< Weight of the squared distance beyond a piece's box, against that off its plane.

/// Piece of a plane: a frame, and the box of its points in it.
template <int Dim>
struct Piece {
  Frame<Dim> frame;
  Vec<Dim> low, high;

  Piece(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const Snap<Dim>& snap)
      : frame(principal_frame<Dim>(moments<Dim>(sites, cell.low, cell.bits), snap.step())), low(Vec<Dim>::Constant(kInfinity)), high(-low) {
    for (const Site<Dim>& site : sites) {
      const Vec<Dim> y = frame.local(snap.local(site));
      low = low.cwiseMin(y);
      high = high.cwiseMax(y);
    }
  }
  [[nodiscard]] double cost(const Vec<Dim>& p) const {
    const Vec<Dim> y = frame.local(p);
    const double outside2 = (low - y).cwiseMax(y - high).cwiseMax(0.0).template head<Dim - 1>().squaredNorm();
    return y[Dim - 1] * y[Dim - 1] + kOutside * outside2;
  }
  [[nodiscard]] double thickness() const { return std::max(-low[Dim - 1], high[Dim - 1]); }
};

template <int Dim, class IsSecond>
Clusters<Dim> divide(std::span<const Site<Dim>> sites, const IsSecond& is_second) {
  Clusters<Dim> clusters;
  for (const Site<Dim>& site : sites) clusters[is_second(site) ? 1 : 0].push_back(site);
  return clusters;
}

template <int Dim>
bool one_is_empty(const Clusters<Dim>& clusters) {
  return clusters[0].empty() || clusters[1].empty();
}

}  // namespace

template <int Dim>
int connected_parts(std::span<const Site<Dim>> sites, const Snap<Dim>& snap, double reach, Clusters<Dim>& clusters) {
  thread_local std::vector<Vec<Dim>> places;
  thread_local std::vector<std::uint32_t> order;  // Reached ones first, in the order in which they are looked at.
  const std::size_t count = sites.size();
  places.clear();
  order.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    places.push_back(snap.local(sites[i]));
    order[i] = static_cast<std::uint32_t>(i);
  }
  std::size_t reached = 0, looked = 0, first_part = count;
  for (int parts = 0;; ++parts) {
    if (reached == count) {
      if (parts == 2) {
        std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(first_part));
        std::sort(order.begin() + static_cast<std::ptrdiff_t>(first_part), order.end());
        for (std::size_t i = 0; i < count; ++i) clusters[i < first_part ? 0 : 1].push_back(sites[order[i]]);
      }
      return parts;
    }
    if (parts == 1) first_part = reached;
    if (parts == 2) return 3;
    ++reached;  // A seed.
    for (; looked < reached; ++looked) {
      const Vec<Dim> from = places[order[looked]];
      for (std::size_t i = reached; i < count; ++i)
        if ((places[order[i]] - from).squaredNorm() <= reach * reach) std::swap(order[i], order[reached++]);
    }
  }
}

template <int Dim>
bool shows_hole(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell, const Frame<Dim>& frame, const Snap<Dim>& snap,
                double radius) {
  const Box<Dim> box = cell.box(snap.step());
  const std::size_t queries = std::min(kQueries, sites.size() / 16);
  for (std::size_t i = 0; i + 1 < sample.size() && i < queries; ++i) {
    const Vec<Dim> middle = 0.5 * (snap.local(sample[i]) + snap.local(sample[i + 1]));
    const Vec<Dim> normal = frame.axes.col(Dim - 1);
    const Vec<Dim> foot = middle - normal * normal.dot(middle - frame.origin);
    if (box.contains(foot) && is_empty_ball<Dim>(sites, cell, foot / snap.step(), radius / snap.step())) return true;
  }
  return false;
}

template <int Dim>
std::optional<Clusters<Dim>> two_clusters(GatheredSites<Dim>& sites, const Cell<Dim>& cell, const FitRules<Dim>& rules, const Frame<Dim>& frame,
                                          int axis) {
  const bool few = sites.size() <= kSample;
  std::vector<Site<Dim>> spread;
  if (!few) spread = spread_sample<Dim>(sites.view(), cell);
  const std::span<const Site<Dim>> sample = few ? sites.all() : std::span<const Site<Dim>>(spread);

  Clusters<Dim> clusters = divide<Dim>(sample, [&](const Site<Dim>& site) { return frame.local(rules.snap.local(site))[axis] > 0.0; });
  double last = kInfinity;
  for (int round = 0;; ++round) {
    if (one_is_empty<Dim>(clusters)) return std::nullopt;
    const Piece<Dim> first(clusters[0], cell, rules.snap), second(clusters[1], cell, rules.snap);
    const double thickness = std::max(first.thickness(), second.thickness());
    const bool thin = thickness <= 2.0 * rules.limit;
    if (!thin && thickness > kProgress * last) return std::nullopt;
    last = thickness;
    const auto nearer_second = [&](const Site<Dim>& site) {
      const Vec<Dim> p = rules.snap.local(site);
      return second.cost(p) < first.cost(p);
    };
    Clusters<Dim> next = divide<Dim>(sample, nearer_second);
    const bool settled = next == clusters;
    if (!settled && round < kRounds) {
      clusters = std::move(next);
      continue;
    }
    if (!thin) return std::nullopt;
    if (few) return clusters;
    if (shows_hole<Dim>(clusters[0], sites.view(), cell, first.frame, rules.snap, kClearHole * rules.limit)) return std::nullopt;
    if (shows_hole<Dim>(clusters[1], sites.view(), cell, second.frame, rules.snap, kClearHole * rules.limit)) return std::nullopt;
    clusters = divide<Dim>(sites.all(), nearer_second);
    if (one_is_empty<Dim>(clusters)) return std::nullopt;
    return clusters;
  }
}

#define VANTAGE_INSTANTIATE(D)                                                                                                        \
  template int connected_parts<D>(std::span<const Site<D>>, const Snap<D>&, double, Clusters<D>&);                                    \
  template bool shows_hole<D>(std::span<const Site<D>>, const SiteView<D>&, const Cell<D>&, const Frame<D>&, const Snap<D>&, double); \
  template std::optional<Clusters<D>> two_clusters<D>(GatheredSites<D>&, const Cell<D>&, const FitRules<D>&, const Frame<D>&, int);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
