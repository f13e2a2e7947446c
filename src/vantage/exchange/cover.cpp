// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/cover.h"

#include <algorithm>
#include <tuple>

#include "vantage/exchange/published.h"
#include "vantage/surface/snap.h"

namespace vantage {
namespace {

/// Times a float: no less than the double it was made from.
constexpr double kRoundedUp = 1.0 + 1e-7;

/// Which sites serve which points.
template <int Dim>
struct Candidates {
  struct Pair {
    CellNumber<Dim> site;
    std::uint32_t point;
    float distance;
  };
  std::vector<CellNumber<Dim>> sites;
  std::vector<double> nearest;                    ///< Upper bound of the distance of a site to its nearest point [m].
  std::vector<std::uint32_t> site_start, served;  ///< Points of each site.
  std::vector<std::uint32_t> point_start, by;     ///< Sites of each point.

  Candidates(const ExchangeLattice<Dim>& lattice, std::span<const Vec<Dim>> points, double reach) {
    std::vector<Pair> pairs;
    point_start.assign(1, 0);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      each_site_near(lattice, points[i], reach,
                     [&](const CellNumber<Dim>& site, double distance) { pairs.push_back({site, i, static_cast<float>(distance)}); });
      point_start.push_back(static_cast<std::uint32_t>(pairs.size()));
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return std::tie(a.site, a.point) < std::tie(b.site, b.point); });
    by.resize(pairs.size());
    std::vector<std::uint32_t> next(point_start.begin(), point_start.end() - 1);
    for (const auto& [site, point, distance] : pairs) {
      if (sites.empty() || sites.back() != site) {
        sites.push_back(site);
        nearest.push_back(kInfinity);
        site_start.push_back(static_cast<std::uint32_t>(served.size()));
      }
      served.push_back(point);
      nearest.back() = std::min(nearest.back(), kRoundedUp * static_cast<double>(distance));
      by[next[point]++] = static_cast<std::uint32_t>(sites.size() - 1);
    }
    site_start.push_back(static_cast<std::uint32_t>(served.size()));
  }
  [[nodiscard]] std::span<const std::uint32_t> points_of(std::uint32_t site) const {
    return std::span(served).subspan(site_start[site], site_start[site + 1] - site_start[site]);
  }
  [[nodiscard]] std::span<const std::uint32_t> sites_of(std::uint32_t point) const {
    return std::span(by).subspan(point_start[point], point_start[point + 1] - point_start[point]);
  }
};

template <int Dim>
std::vector<bool> choose(const Candidates<Dim>& all, std::size_t points) {
  std::vector<std::uint32_t> gain(all.sites.size());
  std::vector<std::vector<std::uint32_t>> by_gain(1);
  for (std::uint32_t s = 0; s < gain.size(); ++s) {
    gain[s] = static_cast<std::uint32_t>(all.points_of(s).size());
    if (gain[s] >= by_gain.size()) by_gain.resize(gain[s] + 1);
    by_gain[gain[s]].push_back(s);
  }
  std::vector<bool> chosen(gain.size(), false), served(points, false);
  for (std::size_t g = by_gain.size() - 1; g > 0; --g)
    for (std::size_t i = 0; i < by_gain[g].size(); ++i) {
      const std::uint32_t site = by_gain[g][i];
      if (chosen[site] || gain[site] != g) continue;
      chosen[site] = true;
      for (const std::uint32_t point : all.points_of(site)) {
        if (served[point]) continue;
        served[point] = true;
        for (const std::uint32_t other : all.sites_of(point))
          if (--gain[other] > 0 && !chosen[other]) by_gain[gain[other]].push_back(other);
      }
    }
  return chosen;
}

/// Takes out, from the last on, what the others serve too.
template <int Dim>
void prune(const Candidates<Dim>& all, std::size_t points, std::vector<bool>& chosen) {
  std::vector<std::uint32_t> times(points, 0);
  for (std::uint32_t s = 0; s < chosen.size(); ++s)
    if (chosen[s])
      for (const std::uint32_t point : all.points_of(s)) ++times[point];
  for (std::uint32_t s = 0; s < chosen.size(); ++s) {
    if (!chosen[s]) continue;
    const auto served = all.points_of(s);
    if (std::any_of(served.begin(), served.end(), [&](std::uint32_t point) { return times[point] < 2; })) continue;
    chosen[s] = false;
    for (const std::uint32_t point : served) --times[point];
  }
}

}  // namespace

template <int Dim>
Cover<Dim> cover(const ExchangeLattice<Dim>& lattice, std::span<const Vec<Dim>> points, double reach) {
  const Candidates<Dim> all(lattice, points, reach);
  std::vector<bool> chosen = choose(all, points.size());
  prune(all, points.size(), chosen);
  std::vector<SiteLeaf<Dim>> leaves;
  Cover<Dim> out;
  for (std::size_t s = 0; s < chosen.size(); ++s) {
    if (!chosen[s]) continue;
    out.farthest = std::max(out.farthest, all.nearest[s]);
    SiteLeaf<Dim> leaf{all.sites[s], static_cast<std::uint8_t>((all.sites[s][0] & 1U) != 0 ? 2U : 1U)};
    for (std::uint32_t& a : leaf.cell) a >>= 1U;
    leaves.push_back(leaf);
  }
  std::stable_sort(leaves.begin(), leaves.end(), [](const auto& a, const auto& b) { return curve_less<Dim>(a.cell, b.cell); });
  for (const SiteLeaf<Dim>& leaf : leaves) {
    if (out.leaves.empty() || out.leaves.back().cell != leaf.cell) out.leaves.push_back({leaf.cell, 0});
    out.leaves.back().sites |= leaf.sites;
  }
  return out;
}

template Cover<2> cover(const ExchangeLattice<2>&, std::span<const Vec<2>>, double);
template Cover<3> cover(const ExchangeLattice<3>&, std::span<const Vec<3>>, double);

}  // namespace vantage
