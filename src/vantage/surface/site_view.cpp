// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/site_view.h"

#include <algorithm>

#include "vantage/surface/proof.h"

namespace vantage {
namespace {

template <int Dim>
void append(const Node<Dim>& node, std::vector<Site<Dim>>& out) {
  if (node.leaf) out.insert(out.end(), node.leaf->sites.begin(), node.leaf->sites.end());
  if (node.inner)
    for (const Node<Dim>& child : node.inner->children) append<Dim>(child, out);
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
  const auto parts = sites.split(cell);
  for (int c = 0; c < Cell<Dim>::kChildren && cell.bits > 1; ++c)
    for (const SiteView<Dim>& part : parts[c].split(cell.child(c))) {
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

#define VANTAGE_INSTANTIATE(D)                                                               \
  template class SiteView<D>;                                                                \
  template bool is_empty_ball<D>(const SiteView<D>&, const Cell<D>&, const Vec<D>&, double); \
  template std::vector<Site<D>> spread_sample<D>(const SiteView<D>&, const Cell<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
