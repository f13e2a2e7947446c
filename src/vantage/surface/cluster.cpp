// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/cluster.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr std::size_t kSample = 128;  ///< More points than these are represented by a spread sample.
constexpr int kRounds = 4;
constexpr double kProgress = 0.8;        ///< A round that thins the pieces by less is the last.
constexpr double kNearlyAll = 1.2;       ///< The pieces of a sample are not quite those of all: by so much must they pass the limit to be given up.
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
void find_parts(std::span<const Site<Dim>> sites, const Snap<Dim>& snap, double reach, Parts& parts) {
  thread_local std::vector<Vec<Dim>> places;  // In the order of parts.order: reached ones first, in the order in which they are looked at.
  places.clear();
  parts.order.resize(sites.size());
  parts.starts.assign(1, 0);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    places.push_back(snap.local(sites[i]));
    parts.order[i] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t reached = 0, looked = 0; reached < sites.size();) {
    ++reached;  // A seed.
    for (; looked < reached; ++looked) {
      const Vec<Dim> from = places[looked];
      for (std::size_t i = reached; i < places.size(); ++i)
        if ((places[i] - from).squaredNorm() <= reach * reach) {
          std::swap(places[i], places[reached]);
          std::swap(parts.order[i], parts.order[reached++]);
        }
    }
    const auto begin = parts.order.begin() + parts.starts.back();
    std::sort(begin, parts.order.begin() + static_cast<std::ptrdiff_t>(reached));
    parts.starts.push_back(static_cast<std::uint32_t>(reached));
  }
}

template <int Dim>
bool shows_hole(std::span<const std::array<Site<Dim>, 2>> pairs, const SiteView<Dim>& sites, const Cell<Dim>& cell, const Frame<Dim>& frame,
                const Snap<Dim>& snap, double radius) {
  const Box<Dim> box = cell.box(snap.step());
  const Vec<Dim> normal = frame.axes.col(Dim - 1);
  return std::any_of(pairs.begin(), pairs.end(), [&](const std::array<Site<Dim>, 2>& pair) {
    const Vec<Dim> middle = 0.5 * (snap.local(pair[0]) + snap.local(pair[1]));
    const Vec<Dim> foot = middle - normal * normal.dot(middle - frame.origin);
    return box.contains(foot) && is_empty_ball<Dim>(sites, cell, foot / snap.step(), radius / snap.step());
  });
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
    const bool thin = thickness <= (few ? 1.0 : kNearlyAll) * rules.limit;
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
    std::array<std::vector<std::array<Site<Dim>, 2>>, 2> pairs;
    for (const auto& pair : probe_pairs<Dim>(sites.view(), cell))
      if (const bool second_one = nearer_second(pair[0]); second_one == nearer_second(pair[1])) pairs[second_one ? 1 : 0].push_back(pair);
    if (shows_hole<Dim>(pairs[0], sites.view(), cell, first.frame, rules.snap, kNearlyAll * rules.limit)) return std::nullopt;
    if (shows_hole<Dim>(pairs[1], sites.view(), cell, second.frame, rules.snap, kNearlyAll * rules.limit)) return std::nullopt;
    clusters = divide<Dim>(sites.all(), nearer_second);
    if (one_is_empty<Dim>(clusters)) return std::nullopt;
    return clusters;
  }
}

#define VANTAGE_INSTANTIATE(D)                                                                                                                       \
  template void find_parts<D>(std::span<const Site<D>>, const Snap<D>&, double, Parts&);                                                             \
  template bool shows_hole<D>(std::span<const std::array<Site<D>, 2>>, const SiteView<D>&, const Cell<D>&, const Frame<D>&, const Snap<D>&, double); \
  template std::optional<Clusters<D>> two_clusters<D>(GatheredSites<D>&, const Cell<D>&, const FitRules<D>&, const Frame<D>&, int);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
