// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/proof.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace vantage {
namespace {

constexpr int kQueries = 96;  ///< Balls tried for islands.

/// Are all simplices of `next` with Dim of the chosen wide enough?
template <int Dim>
bool in_general_position(std::span<const Vec<Dim>> chosen, const Vec<Dim>& next, double least_width) {
  std::array<int, Dim> pick;
  for (int i = 0; i < Dim; ++i) pick[i] = i;
  const int count = static_cast<int>(chosen.size());
  if (count < Dim) return true;
  for (;;) {
    std::array<Vec<Dim>, Dim + 1> simplex;
    for (int i = 0; i < Dim; ++i) simplex[i] = chosen[pick[i]];
    simplex[Dim] = next;
    if (!(width<Dim>(simplex) > least_width)) return false;
    int i = Dim - 1;  // Next combination.
    while (i >= 0 && pick[i] == count - Dim + i) --i;
    if (i < 0) return true;
    ++pick[i];
    for (int j = i + 1; j < Dim; ++j) pick[j] = pick[j - 1] + 1;
  }
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
std::unique_ptr<Proof<Dim>> Proof<Dim>::find(const SiteView<Dim>& sites, const Cell<Dim>& cell, double tolerance) {
  const auto sample = spread_sample<Dim>(sites, cell);
  Proof proof;
  if (proof.find_islands(sample, sites, cell, tolerance) || proof.find_general(sample, tolerance)) return std::make_unique<Proof>(proof);
  return nullptr;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::find_general(std::span<const Site<Dim>> sample, double tolerance) {
  std::vector<Vec<Dim>> chosen;
  for (const Site<Dim>& site : sample) {
    const Vec<Dim> p = lattice_place<Dim>(site);
    // The first ones must lie apart, or every simplex with them is thin.
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](const Vec<Dim>& q) { return (q - p).norm() > 4.0 * tolerance; });
    if (!apart || !in_general_position<Dim>(chosen, p, 2.0 * tolerance)) continue;
    sites_[chosen.size()] = site;
    chosen.push_back(p);
    count_ = static_cast<int>(chosen.size());
    if (count_ == kGeneral) return true;
  }
  return false;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::find_islands(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell, double tolerance) {
  int queries = 0;
  const int most_queries = static_cast<int>(std::min<std::size_t>(kQueries, sites.size() / 16));
  radius_ = 2.0 * tolerance;
  /// An empty ball between two sites.
  const auto gap = [&](const Site<Dim>& from, const Site<Dim>& to) -> std::optional<Vec<Dim>> {
    const Vec<Dim> a = lattice_place<Dim>(from), b = lattice_place<Dim>(to);
    if ((b - a).norm() <= 2.0 * radius_) return std::nullopt;
    for (const double t : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875}) {
      if (++queries > most_queries) return std::nullopt;
      const Vec<Dim> y = a + t * (b - a);
      if (is_empty_ball<Dim>(sites, cell, y, radius_)) return y;
    }
    return std::nullopt;
  };
  for (std::size_t i = 0; i + 2 < sample.size(); ++i)
    for (std::size_t j = i + 1; j + 1 < sample.size() && j < i + 6; ++j) {
      const auto ij = gap(sample[i], sample[j]);
      if (!ij) continue;
      for (std::size_t k = j + 1; k < sample.size() && k < j + 6; ++k) {
        if (queries > most_queries) return false;
        const auto ik = gap(sample[i], sample[k]);
        const auto jk = ik ? gap(sample[j], sample[k]) : std::nullopt;
        if (!jk) continue;
        sites_[0] = sample[i];
        sites_[1] = sample[j];
        sites_[2] = sample[k];
        balls_ = {*ij, *ik, *jk};
        count_ = kIslands;
        return true;
      }
    }
  return false;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::survives_adding(std::span<const Site<Dim>> sites, const Cell<Dim>& cell) const {
  return count_ != kIslands ||
         std::all_of(balls_.begin(), balls_.end(), [&](const Vec<Dim>& ball) { return is_empty_ball<Dim>(sites, cell, ball, radius_); });
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::survives_removing(std::span<const Site<Dim>> sites) const {
  return std::none_of(sites_.begin(), sites_.begin() + count_,
                      [&](const Site<Dim>& site) { return std::binary_search(sites.begin(), sites.end(), site, morton_less<Dim>); });
}

template class Proof<2>;
template class Proof<3>;

}  // namespace vantage
