// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/snap.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"

namespace vantage {
namespace {

constexpr double kSteps = 4294967296.0;  // 2^32

template <int Dim>
struct Keyed {
  std::uint64_t key;
  Site<Dim> site;
};

/// Bytes with Dim - 1 zeros before each bit.
template <int Dim>
const std::array<std::uint64_t, 256>& spread_bytes() {
  static const auto table = [] {
    std::array<std::uint64_t, 256> out{};
    for (std::size_t byte = 0; byte < out.size(); ++byte)
      for (int bit = 0; bit < 8; ++bit) out[byte] |= static_cast<std::uint64_t>((byte >> bit) & 1U) << (bit * Dim);
    return out;
  }();
  return table;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Snap<Dim>::Snap(const Box<Dim>& domain, double quantum) {
  require(!domain.empty() && domain.low.allFinite() && domain.high.allFinite(), "domain of interest: the box is empty or not finite");
  const double side = domain.size().maxCoeff();
  require(side > 0.0, "domain of interest: the box has no extent");
  const Vec<Dim> half = Vec<Dim>::Constant(0.5 * side);
  cube_ = {domain.center() - half, domain.center() + half};
  step_ = side / kSteps;
  quantum_ = static_cast<std::uint32_t>(std::clamp(std::floor(quantum / step_), 1.0, kSteps / 4.0));
}

template <int Dim>
  requires SpatialDim<Dim>
std::optional<Site<Dim>> Snap<Dim>::site(const Vec<Dim>& p) const {
  Site<Dim> site{};
  site[Dim] = 1;
  for (int a = 0; a < Dim; ++a) {
    if (p[a] < cube_.low[a] || p[a] > cube_.high[a]) return std::nullopt;
    const double x = std::floor((p[a] - cube_.low[a]) / step_ + 0.5);
    site[a] = static_cast<std::uint32_t>(std::clamp(x, 0.0, kSteps - 1.0));
    if (quantum_ > 1) site[a] = std::min(site[a] / quantum_ * quantum_ + quantum_ / 2, ~std::uint32_t{0});
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
  const double cell = quantum_ > 1 ? 0.5 * (static_cast<double>(quantum_) + 1.0) * step_ : 0.0;
  return std::sqrt(static_cast<double>(Dim)) * (cell + step_ + 16.0 * 0x1p-52 * largest + 1e-12 * kSteps * step_);
}

template <int Dim>
void sort_sites(std::vector<Site<Dim>>& sites) {
  // By the leading 16 levels with a radix sort, then the few that share a cell of that size.
  constexpr int kDigit = 12;
  const auto& table = spread_bytes<Dim>();
  std::vector<Keyed<Dim>> from(sites.size()), to(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    from[i] = {0, sites[i]};
    for (int a = 0; a < Dim; ++a) from[i].key |= ((table[sites[i][a] >> 24] << (8 * Dim)) | table[(sites[i][a] >> 16) & 255U]) << a;
  }
  constexpr int kRounds = (16 * Dim + kDigit - 1) / kDigit;
  constexpr std::uint64_t kMask = (1U << kDigit) - 1U;
  std::vector<std::array<std::uint32_t, kRounds>> start(kMask + 2);
  for (const auto& item : from)
    for (int round = 0; round < kRounds; ++round) ++start[((item.key >> (round * kDigit)) & kMask) + 1][round];
  for (std::size_t digit = 0; digit <= kMask; ++digit)
    for (int round = 0; round < kRounds; ++round) start[digit + 1][round] += start[digit][round];
  for (int round = 0; round < kRounds; ++round) {
    for (const auto& item : from) to[start[(item.key >> (round * kDigit)) & kMask][round]++] = item;
    std::swap(from, to);
  }
  for (std::size_t i = 0; i < sites.size(); ++i) sites[i] = from[i].site;
  for (std::size_t begin = 0, end = 0; begin < sites.size(); begin = end) {
    while (end < sites.size() && from[end].key == from[begin].key) ++end;
    if (end - begin > 1)
      std::sort(sites.begin() + static_cast<std::ptrdiff_t>(begin), sites.begin() + static_cast<std::ptrdiff_t>(end), morton_less<Dim>);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (kept > 0 && same_site<Dim>(sites[kept - 1], sites[i])) {
      add_count(sites[kept - 1], count_of(sites[i]));
    } else {
      sites[kept++] = sites[i];
    }
  }
  sites.resize(kept);
}

template <int Dim>
std::array<std::span<const Site<Dim>>, Cell<Dim>::kChildren> Cell<Dim>::split(std::span<const Site<Dim>> sites) const {
  std::array<std::span<const Site<Dim>>, kChildren> parts;
  parts[0] = sites;
  for (int a = Dim - 1; a >= 0; --a)  // Halves along the last axis, these along the one before, ...
    for (int c = 0; c < kChildren; c += 2 << a) {
      const std::span<const Site<Dim>> whole = parts[c];
      const auto middle =
          std::partition_point(whole.begin(), whole.end(), [&](const Site<Dim>& site) { return ((site[a] >> (bits - 1)) & 1U) == 0; });
      parts[c] = whole.first(static_cast<std::size_t>(middle - whole.begin()));
      parts[c + (1 << a)] = whole.subspan(parts[c].size());
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
