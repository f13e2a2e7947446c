// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/proof.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace vantage {
namespace {

constexpr std::size_t kQueries = 96;  ///< Balls tried for islands.

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

/// Empty balls between sites, as long as there are tries left.
template <int Dim>
class GapSearch {
 public:
  GapSearch(const SiteView<Dim>& sites, const Cell<Dim>& cell, double radius)
      : sites_(sites), cell_(cell), radius_(radius), left_(std::min<std::size_t>(kQueries, sites.size() / 16)) {}

  [[nodiscard]] bool exhausted() const { return left_ == 0; }
  /// Centre of a ball on the way from one to the other.
  std::optional<Vec<Dim>> between(const Site<Dim>& from, const Site<Dim>& to) {
    const Vec<Dim> a = lattice_place<Dim>(from), b = lattice_place<Dim>(to);
    if ((b - a).norm() <= 2.0 * radius_) return std::nullopt;
    for (const double t : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875}) {
      if (left_ == 0) return std::nullopt;
      --left_;
      const Vec<Dim> y = a + t * (b - a);
      if (is_empty_ball<Dim>(sites_, cell_, y, radius_)) return y;
    }
    return std::nullopt;
  }

 private:
  const SiteView<Dim>& sites_;
  const Cell<Dim>& cell_;
  double radius_;
  std::size_t left_;
};

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
std::unique_ptr<Proof<Dim>> Proof<Dim>::find(const SiteView<Dim>& sites, const Cell<Dim>& cell, const Question& question) {
  const auto sample = spread_sample<Dim>(sites, cell);
  Proof proof;
  proof.radius_ = question.data + question.surface;
  const bool islands = question.patches == 1 ? proof.find_two_islands(sample, sites, cell) : proof.find_three_islands(sample, sites, cell);
  if (islands || proof.find_general(sample, question.data, question.patches)) return std::make_unique<Proof>(proof);
  return nullptr;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::find_general(std::span<const Site<Dim>> sample, double tolerance, int patches) {
  std::vector<Vec<Dim>> chosen;
  for (const Site<Dim>& site : sample) {
    const Vec<Dim> p = lattice_place<Dim>(site);
    // The first ones must lie apart, or every simplex with them is thin.
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](const Vec<Dim>& q) { return (q - p).norm() > 4.0 * tolerance; });
    if (!apart || !in_general_position<Dim>(chosen, p, 2.0 * tolerance)) continue;
    sites_[chosen.size()] = site;
    chosen.push_back(p);
    count_ = static_cast<int>(chosen.size());
    if (count_ == Dim * patches + 1) return true;
  }
  return false;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::find_two_islands(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell) {
  GapSearch<Dim> gaps(sites, cell, radius_);
  for (std::size_t i = 0; i + 1 < sample.size() && !gaps.exhausted(); ++i)
    if (const auto ball = gaps.between(sample[i], sample[i + 1])) {
      sites_[0] = sample[i];
      sites_[1] = sample[i + 1];
      balls_[0] = *ball;
      count_ = 2;
      ball_count_ = 1;
      return true;
    }
  return false;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::find_three_islands(std::span<const Site<Dim>> sample, const SiteView<Dim>& sites, const Cell<Dim>& cell) {
  GapSearch<Dim> gaps(sites, cell, radius_);
  for (std::size_t i = 0; i + 2 < sample.size(); ++i)
    for (std::size_t j = i + 1; j + 1 < sample.size() && j < i + 6; ++j) {
      const auto ij = gaps.between(sample[i], sample[j]);
      if (!ij) continue;
      for (std::size_t k = j + 1; k < sample.size() && k < j + 6; ++k) {
        if (gaps.exhausted()) return false;
        const auto ik = gaps.between(sample[i], sample[k]);
        const auto jk = ik ? gaps.between(sample[j], sample[k]) : std::nullopt;
        if (!jk) continue;
        sites_[0] = sample[i];
        sites_[1] = sample[j];
        sites_[2] = sample[k];
        balls_ = {*ij, *ik, *jk};
        count_ = ball_count_ = 3;
        return true;
      }
    }
  return false;
}

template <int Dim>
  requires SpatialDim<Dim>
bool Proof<Dim>::survives_adding(std::span<const Site<Dim>> sites, const Cell<Dim>& cell) const {
  return std::all_of(balls_.begin(), balls_.begin() + ball_count_,
                     [&](const Vec<Dim>& ball) { return is_empty_ball<Dim>(sites, cell, ball, radius_); });
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
