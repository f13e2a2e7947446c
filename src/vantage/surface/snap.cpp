// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/snap.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"

namespace vantage {
namespace {

constexpr double kSteps = 4294967296.0;  // 2^32

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Snap<Dim>::Snap(const Box<Dim>& domain) {
  require(!domain.empty() && domain.low.allFinite() && domain.high.allFinite(), "domain of interest: the box is empty or not finite");
  const double side = domain.size().maxCoeff();
  require(side > 0.0, "domain of interest: the box has no extent");
  const Vec<Dim> half = Vec<Dim>::Constant(0.5 * side);
  cube_ = {domain.center() - half, domain.center() + half};
  step_ = side / kSteps;
}

template <int Dim>
  requires SpatialDim<Dim>
std::optional<Site<Dim>> Snap<Dim>::site(const Vec<Dim>& p) const {
  Site<Dim> site;
  for (int a = 0; a < Dim; ++a) {
    if (p[a] < cube_.low[a] || p[a] > cube_.high[a]) return std::nullopt;
    const double x = std::floor((p[a] - cube_.low[a]) / step_ + 0.5);
    site[a] = static_cast<std::uint32_t>(std::clamp(x, 0.0, kSteps - 1.0));
  }
  return site;
}

template <int Dim>
  requires SpatialDim<Dim>
Vec<Dim> Snap<Dim>::local(const Site<Dim>& site) const {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = static_cast<double>(site[a]) * step_;
  return p;
}

template <int Dim>
  requires SpatialDim<Dim>
double Snap<Dim>::slack() const {
  // One step a coordinate (half inside, a whole one on the high faces), and a few roundings of world coordinates and of fits.
  const double largest = std::max(cube_.low.cwiseAbs().maxCoeff(), cube_.high.cwiseAbs().maxCoeff());
  return std::sqrt(static_cast<double>(Dim)) * (step_ + 16.0 * 0x1p-52 * largest + 1e-12 * kSteps * step_);
}

template <int Dim>
void sort_sites(std::vector<Site<Dim>>& sites) {
  std::sort(sites.begin(), sites.end(), morton_less<Dim>);
}

template <int Dim>
std::array<std::span<const Site<Dim>>, Cell<Dim>::kChildren> Cell<Dim>::split(std::span<const Site<Dim>> sites) const {
  std::array<std::span<const Site<Dim>>, kChildren> parts;
  for (int c = 0; c < kChildren; ++c) {
    const auto end = std::partition_point(sites.begin(), sites.end(), [&](const Site<Dim>& site) { return child_of(site) <= c; });
    parts[c] = sites.first(static_cast<std::size_t>(end - sites.begin()));
    sites = sites.subspan(parts[c].size());
  }
  return parts;
}

template <int Dim>
bool is_empty_ball(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const Vec<Dim>& center, double radius) {
  if (sites.empty() || cell.box(1.0).distance(center) > radius) return true;
  if (sites.size() <= 16 || cell.bits == 0)
    return std::all_of(sites.begin(), sites.end(),
                       [&](const Site<Dim>& site) { return (lattice_place<Dim>(site) - center).squaredNorm() > radius * radius; });
  const auto parts = cell.split(sites);
  for (int c = 0; c < Cell<Dim>::kChildren; ++c)
    if (!is_empty_ball<Dim>(parts[c], cell.child(c), center, radius)) return false;
  return true;
}

template <int Dim>
std::vector<Site<Dim>> spread_sample(std::span<const Site<Dim>> sites, const Cell<Dim>& cell) {
  std::vector<Site<Dim>> near, sample;
  const auto parts = cell.split(sites);
  for (int c = 0; c < Cell<Dim>::kChildren && cell.bits > 1; ++c)
    for (const auto& part : cell.child(c).split(parts[c])) {
      if (part.empty()) continue;
      near.push_back(part[0]);
      if (part.size() > 1) near.push_back(part[part.size() / 2]);
    }
  constexpr std::size_t kStride = 37;  // Prime to the number of sites below, which is made a multiple of 8 and is below 8 * 37.
  const std::size_t round = (near.size() + 7) / 8 * 8;
  for (std::size_t i = 0; i < round; ++i)
    if (const std::size_t n = i * kStride % round; n < near.size()) sample.push_back(near[n]);
  return sample;
}

#define VANTAGE_INSTANTIATE(D)                                                                     \
  template class Snap<D>;                                                                          \
  template void sort_sites<D>(std::vector<Site<D>>&);                                              \
  template struct Cell<D>;                                                                         \
  template bool is_empty_ball<D>(std::span<const Site<D>>, const Cell<D>&, const Vec<D>&, double); \
  template std::vector<Site<D>> spread_sample<D>(std::span<const Site<D>>, const Cell<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
