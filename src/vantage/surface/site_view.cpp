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

/// First and middle sites of the cell's descendants so many levels down.
template <int Dim>
void spread(const SiteView<Dim>& sites, const Cell<Dim>& cell, int levels, std::vector<Site<Dim>>& out) {
  if (sites.empty()) return;
  if (levels == 0 || cell.bits == 0) {
    out.push_back(sites[0]);
    if (sites.size() > 1) out.push_back(sites[sites.size() / 2]);
    return;
  }
  const auto parts = sites.split(cell);
  for (int c = 0; c < Cell<Dim>::kChildren; ++c) spread<Dim>(parts[c], cell.child(c), levels - 1, out);
}

}  // namespace

template <int Dim>
SiteView<Dim>::SiteView(const Node<Dim>& node) : inner_(node.inner.get()) {
  if (node.leaf) sites_ = node.leaf->sites;
}

template <int Dim>
std::size_t SiteView<Dim>::size() const {
  return inner_ != nullptr ? static_cast<std::size_t>(inner_->totals.points) : sites_.size();
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
  spread<Dim>(sites, cell, sites.size() > kManySites ? 3 : 2, near);
  constexpr std::size_t kStride = 397;  // A prime, so that the steps go through all sites.
  const std::size_t round = near.size() % kStride == 0 ? near.size() + 1 : near.size();
  for (std::size_t i = 0; i < round; ++i)
    if (const std::size_t n = i * kStride % round; n < near.size()) sample.push_back(near[n]);
  return sample;
}

#define VANTAGE_INSTANTIATE(D)                                                               \
  template class SiteView<D>;                                                                \
  template bool is_empty_ball<D>(const SiteView<D>&, const Cell<D>&, const Vec<D>&, double); \
  template std::vector<Site<D>> spread_sample<D>(const SiteView<D>&, const Cell<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
