// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/site_view.h"

#include <algorithm>

#include "vantage/surface/proof.h"

namespace vantage {
namespace {

constexpr std::size_t kManySites = 8192;  ///< More are sampled a level deeper.

template <int Dim>
void append(const Node<Dim>& node, std::vector<Site<Dim>>& out) {
  if (node.leaf) out.insert(out.end(), node.leaf->sites.begin(), node.leaf->sites.end());
  if (node.inner)
    for (const Node<Dim>& child : node.inner->children) append<Dim>(child, out);
}

/// The cell's descendants so many levels down that hold sites.
template <int Dim>
void descendants(const SiteView<Dim>& sites, const Cell<Dim>& cell, int levels, std::vector<SiteView<Dim>>& out) {
  if (sites.empty()) return;
  if (levels == 0 || cell.bits == 0) return out.push_back(sites);
  const auto parts = sites.split(cell);
  for (int c = 0; c < Cell<Dim>::kChildren; ++c) descendants<Dim>(parts[c], cell.child(c), levels - 1, out);
}

template <int Dim>
std::vector<SiteView<Dim>> descendants(const SiteView<Dim>& sites, const Cell<Dim>& cell) {
  std::vector<SiteView<Dim>> out;
  descendants<Dim>(sites, cell, sites.size() > kManySites ? 3 : 2, out);
  return out;
}

}  // namespace

template <int Dim>
SiteView<Dim>::SiteView(const Node<Dim>& node) : inner_(node.inner.get()) {
  if (node.leaf) sites_ = node.leaf->sites;
}

template <int Dim>
std::size_t SiteView<Dim>::size() const {
  return inner_ != nullptr ? static_cast<std::size_t>(inner_->totals.sites) : sites_.size();
}

template <int Dim>
const Site<Dim>& SiteView<Dim>::operator[](std::size_t rank) const {
  if (inner_ == nullptr) return sites_[rank];
  std::size_t child = 0;
  for (;; ++child) {
    const std::size_t here = SiteView(inner_->children[child]).size();
    if (rank < here) break;
    rank -= here;
  }
  return SiteView(inner_->children[child])[rank];
}

template <int Dim>
std::array<SiteView<Dim>, Cell<Dim>::kChildren> SiteView<Dim>::split(const Cell<Dim>& cell) const {
  std::array<SiteView, Cell<Dim>::kChildren> parts;
  if (inner_ != nullptr) {
    for (int c = 0; c < Cell<Dim>::kChildren; ++c) parts[c] = SiteView(inner_->children[c]);
  } else {
    const auto spans = cell.split(sites_);
    for (int c = 0; c < Cell<Dim>::kChildren; ++c) parts[c] = SiteView(spans[c]);
  }
  return parts;
}

template <int Dim>
std::vector<Site<Dim>> SiteView<Dim>::collect() const {
  if (inner_ == nullptr) return {sites_.begin(), sites_.end()};
  std::vector<Site<Dim>> out;
  out.reserve(size());
  for (const Node<Dim>& child : inner_->children) append<Dim>(child, out);
  return out;
}

template <int Dim>
bool is_empty_ball(const SiteView<Dim>& sites, const Cell<Dim>& cell, const Vec<Dim>& center, double radius) {
  if (sites.empty() || cell.box(1.0).distance(center) > radius) return true;
  if (sites.in_one_span() && (sites.size() <= 16 || cell.bits == 0)) {
    const auto outside = [&](const Site<Dim>& site) { return (lattice_place<Dim>(site) - center).squaredNorm() > radius * radius; };
    return std::all_of(sites.span().begin(), sites.span().end(), outside);
  }
  const auto parts = sites.split(cell);
  for (int c = 0; c < Cell<Dim>::kChildren; ++c)
    if (!is_empty_ball<Dim>(parts[c], cell.child(c), center, radius)) return false;
  return true;
}

template <int Dim>
std::vector<Site<Dim>> spread_sample(const SiteView<Dim>& sites, const Cell<Dim>& cell) {
  std::vector<Site<Dim>> near, sample;
  for (const SiteView<Dim>& part : descendants<Dim>(sites, cell)) {
    near.push_back(part[0]);
    if (part.size() > 1) near.push_back(part[part.size() / 2]);
  }
  constexpr std::size_t kStride = 397;  // A prime, so that the steps go through all sites.
  const std::size_t round = near.size() % kStride == 0 ? near.size() + 1 : near.size();
  for (std::size_t i = 0; i < round; ++i)
    if (const std::size_t n = i * kStride % round; n < near.size()) sample.push_back(near[n]);
  return sample;
}

template <int Dim>
std::vector<std::array<Site<Dim>, 2>> probe_pairs(const SiteView<Dim>& sites, const Cell<Dim>& cell) {
  constexpr std::size_t kSamplePairs = 48, kSparse = 32, kEach = 4;
  std::vector<std::array<Site<Dim>, 2>> pairs;
  const std::vector<Site<Dim>> sample = spread_sample<Dim>(sites, cell);
  for (std::size_t i = 0; i + 1 < sample.size() && i < std::min(kSamplePairs, sites.size() / 16); ++i) pairs.push_back({sample[i], sample[i + 1]});
  if (sites.size() <= kManySites) return pairs;
  auto parts = descendants<Dim>(sites, cell);
  std::stable_sort(parts.begin(), parts.end(), [](const SiteView<Dim>& a, const SiteView<Dim>& b) { return a.size() < b.size(); });
  for (std::size_t p = 0; p < std::min(kSparse, parts.size()); ++p) {
    const std::size_t count = std::min(kEach, parts[p].size());
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j) pairs.push_back({parts[p][i * parts[p].size() / count], parts[p][j * parts[p].size() / count]});
  }
  return pairs;
}

#define VANTAGE_INSTANTIATE(D)                                                               \
  template class SiteView<D>;                                                                \
  template bool is_empty_ball<D>(const SiteView<D>&, const Cell<D>&, const Vec<D>&, double); \
  template std::vector<Site<D>> spread_sample<D>(const SiteView<D>&, const Cell<D>&);        \
  template std::vector<std::array<Site<D>, 2>> probe_pairs<D>(const SiteView<D>&, const Cell<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
