// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/cluster.h"

namespace vantage {
namespace {

constexpr std::size_t kSample = 256;  ///< The pieces are found on at most so many points.
constexpr int kRounds = 5;
constexpr double kOutside = 1.0 / 64.0;  ///< Weight of the squared distance beyond a piece's box, against that off its plane.

/// Piece of a plane: a frame, and the box of its points in it.
template <int Dim>
struct Piece {
  Frame<Dim> frame;
  Vec<Dim> low, high;

  Piece(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const Snap<Dim>& snap)
      : frame(principal_frame<Dim>(moments<Dim>(sites, cell.low, cell.bits), cell.low, snap.step())), low(Vec<Dim>::Constant(kInfinity)), high(-low) {
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

template <int Dim>
using Clusters = std::array<std::vector<Site<Dim>>, 2>;

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
std::optional<Clusters<Dim>> two_clusters(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules,
                                          const Frame<Dim>& frame, int axis) {
  const std::size_t stride = (sites.size() + kSample - 1) / kSample;
  std::vector<Site<Dim>> sample;
  for (std::size_t i = 0; i < sites.size(); i += stride) sample.push_back(sites[i]);

  Clusters<Dim> clusters = divide<Dim>(sample, [&](const Site<Dim>& site) { return frame.local(rules.snap.local(site))[axis] > 0.0; });
  for (int round = 0;; ++round) {
    if (one_is_empty<Dim>(clusters)) return std::nullopt;
    const Piece<Dim> first(clusters[0], cell, rules.snap), second(clusters[1], cell, rules.snap);
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
    if (std::max(first.thickness(), second.thickness()) > 2.0 * rules.limit) return std::nullopt;
    if (stride > 1) clusters = divide<Dim>(sites, nearer_second);
    if (one_is_empty<Dim>(clusters)) return std::nullopt;
    return clusters;
  }
}

#define VANTAGE_INSTANTIATE(D) \
  template std::optional<Clusters<D>> two_clusters<D>(std::span<const Site<D>>, const Cell<D>&, const FitRules<D>&, const Frame<D>&, int);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
