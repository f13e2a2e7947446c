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

#define VANTAGE_INSTANTIATE(D)                        \
  template class Snap<D>;                             \
  template void sort_sites<D>(std::vector<Site<D>>&); \
  template struct Cell<D>;
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
