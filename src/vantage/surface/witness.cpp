// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/witness.h"

#include <algorithm>
#include <vector>

namespace vantage {
namespace {

constexpr std::size_t kSample = 48;

template <int Dim>
Vec<Dim> place(const Site<Dim>& site) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = static_cast<double>(site[a]);
  return p;
}

/// Are all simplices of `next` with Dim of the chosen wide enough?
template <int Dim>
bool in_general_position(std::span<const Vec<Dim>> chosen, const Vec<Dim>& next, double tolerance) {
  std::array<int, Dim> pick;
  for (int i = 0; i < Dim; ++i) pick[i] = i;
  const int count = static_cast<int>(chosen.size());
  if (count < Dim) return true;
  for (;;) {
    std::array<Vec<Dim>, Dim + 1> simplex;
    for (int i = 0; i < Dim; ++i) simplex[i] = chosen[pick[i]];
    simplex[Dim] = next;
    if (!(width<Dim>(simplex) > 2.0 * tolerance)) return false;
    int i = Dim - 1;  // Next combination.
    while (i >= 0 && pick[i] == count - Dim + i) --i;
    if (i < 0) return true;
    ++pick[i];
    for (int j = i + 1; j < Dim; ++j) pick[j] = pick[j - 1] + 1;
  }
}

}  // namespace

template <int Dim>
std::optional<Witness<Dim>> find_witness(std::span<const Site<Dim>> sites, double tolerance) {
  // A sample in bit-reversed order: neighbours of the curve come late.
  std::vector<Site<Dim>> sample;
  const std::size_t count = std::min(sites.size(), kSample);
  for (std::size_t i = 0; i < 64 && count > 0; ++i) {
    std::size_t reversed = 0;
    for (int bit = 0; bit < 6; ++bit) reversed |= ((i >> bit) & 1) << (5 - bit);
    if (reversed < count) sample.push_back(sites[reversed * sites.size() / count]);
  }
  Witness<Dim> witness;
  std::vector<Vec<Dim>> chosen;
  for (const Site<Dim>& site : sample) {
    const Vec<Dim> p = place<Dim>(site);
    // The first ones must lie apart, or every simplex with them is thin.
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](const Vec<Dim>& q) { return (q - p).norm() > 4.0 * tolerance; });
    if (!apart || !in_general_position<Dim>(chosen, p, tolerance)) continue;
    witness.sites[chosen.size()] = site;
    chosen.push_back(p);
    if (static_cast<int>(chosen.size()) == Witness<Dim>::kCount) return witness;
  }
  return std::nullopt;
}

template std::optional<Witness<2>> find_witness<2>(std::span<const Site<2>>, double);
template std::optional<Witness<3>> find_witness<3>(std::span<const Site<3>>, double);

}  // namespace vantage
