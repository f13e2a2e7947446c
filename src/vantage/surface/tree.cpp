// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/tree.h"

#include <algorithm>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// A proof is worth looking for in nodes of so many points, and threads in updates of so many.
constexpr std::size_t kProofPoints = 256;
constexpr std::size_t kParallelPoints = 2048;

template <int Dim>
std::vector<Site<Dim>> combined(std::span<const Site<Dim>> old, std::span<const Site<Dim>> sites, bool add) {
  std::vector<Site<Dim>> out;
  out.reserve(old.size() + (add ? sites.size() : 0));
  if (add) {
    std::merge(old.begin(), old.end(), sites.begin(), sites.end(), std::back_inserter(out), morton_less<Dim>);
  } else {
    std::set_difference(old.begin(), old.end(), sites.begin(), sites.end(), std::back_inserter(out), morton_less<Dim>);
  }
  return out;
}

}  // namespace

void Totals::add(const Totals& other) {
  points += other.points;
  nodes += other.nodes;
  leaves += other.leaves;
  fits += other.fits;
  segments += other.segments;
  loose += other.loose;
  depth = std::max(depth, other.depth);
  data_to_surface = std::max(data_to_surface, other.data_to_surface);
  surface_to_data = std::max(surface_to_data, other.surface_to_data);
}

template <int Dim>
Change<Dim> Tree<Dim>::insert(std::span<const Site<Dim>> sites) {
  return sites.empty() ? Change<Dim>{} : update(root_, {}, sites, Action::insert);
}

template <int Dim>
Change<Dim> Tree<Dim>::remove(std::span<const Site<Dim>> sites) {
  return sites.empty() ? Change<Dim>{} : update(root_, {}, sites, Action::remove);
}

/// Children first: then the node's own test reads what is there.
template <int Dim>
Change<Dim> Tree<Dim>::update(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Action action) {
  if (!node.inner) return update_leaf(node, cell, sites, action);
  InnerNode<Dim>& inner = *node.inner;
  const auto parts = cell.split(sites);
  std::array<Change<Dim>, Cell<Dim>::kChildren> changes;
  parallel_for(Cell<Dim>::kChildren, sites.size() >= kParallelPoints ? 1 : Cell<Dim>::kChildren, [&](std::size_t c) {
    if (!parts[c].empty()) changes[c] = update(inner.children[c], cell.child(static_cast<int>(c)), parts[c], action);
  });
  Change<Dim> change;
  for (const Change<Dim>& part : changes) change.add(part);
  ++change.nodes_touched;
  sum_up(inner, cell);
  if (action == Action::insert) {
    inner.moments.add(moments<Dim>(sites, cell.low, cell.bits));
  } else {
    inner.moments = {};
    for (int c = 0; c < Cell<Dim>::kChildren; ++c) inner.moments.add(moments_of(inner.children[c], cell.child(c)));
  }

  if (inner.proof) {
    const bool stands = action == Action::insert ? inner.proof->survives_adding(sites, cell) : inner.proof->survives_removing(sites);
    if (stands && inner.totals.points >= rules_.min_points) return change;
    inner.proof.reset();
  }
  GatheredSites<Dim> all{SiteView<Dim>(node)};
  inner.proof = prove(all.view(), cell);
  if (inner.proof) return change;
  Node<Dim> whole;
  if (set_leaf(whole, cell, all, inner.moments)) {  // Prune.
    change.changed.extend(bounds(node));
    change.changed.extend(bounds(whole));
    node = std::move(whole);
  }
  change.points_read += static_cast<std::int64_t>(all.read());
  return change;
}

template <int Dim>
Change<Dim> Tree<Dim>::update_leaf(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Action action) {
  const std::span<const Site<Dim>> old = node.leaf ? std::span<const Site<Dim>>(node.leaf->sites) : std::span<const Site<Dim>>();
  const std::vector<Site<Dim>> all = combined<Dim>(old, sites, action == Action::insert);
  if (all.size() == old.size()) return {};
  const Box<Dim> before = bounds(node);
  node = {};
  Change<Dim> change = build(node, cell, all);
  change.changed.extend(before);
  return change;
}

/// The node rule of Sec. IV.
template <int Dim>
Change<Dim> Tree<Dim>::build(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites) {
  if (sites.empty()) return {};
  Change<Dim> change;
  change.nodes_touched = 1;
  change.points_read = static_cast<std::int64_t>(sites.size());
  const Moments<Dim> sums = moments<Dim>(sites, cell.low, cell.bits);
  GatheredSites<Dim> all{SiteView<Dim>(sites)};
  auto proof = cell.depth() < max_depth_ ? prove(all.view(), cell) : nullptr;
  if (!proof && set_leaf(node, cell, all, sums)) {
    change.changed = bounds(node);
    return change;
  }
  node.inner = std::make_unique<InnerNode<Dim>>();
  node.inner->moments = sums;
  node.inner->proof = std::move(proof);
  const auto parts = cell.split(sites);
  std::array<Change<Dim>, Cell<Dim>::kChildren> changes;
  parallel_for(Cell<Dim>::kChildren, sites.size() >= kParallelPoints ? 1 : Cell<Dim>::kChildren,
               [&](std::size_t c) { changes[c] = build(node.inner->children[c], cell.child(static_cast<int>(c)), parts[c]); });
  for (const Change<Dim>& part : changes) change.add(part);
  sum_up(*node.inner, cell);
  return change;
}

/// False: the cell must be split.
template <int Dim>
bool Tree<Dim>::set_leaf(Node<Dim>& node, const Cell<Dim>& cell, GatheredSites<Dim>& sites, const Moments<Dim>& sums) const {
  CellFit<Dim> fit;
  const bool few = static_cast<std::int64_t>(sites.size()) < rules_.min_points;
  if (few) {
    for (std::uint32_t i = 0; i < sites.size() && !rules_.paper; ++i) fit.loose.push_back(i);
  } else if (auto whole = fit_cell<Dim>(sites, sums, cell, rules_)) {
    fit = std::move(*whole);
  } else if (cell.depth() >= max_depth_) {
    fit = fit_at_limit<Dim>(sites.all(), cell, rules_);
  } else {
    return false;
  }
  const std::span<const Site<Dim>> all = sites.all();
  const auto same = [&](std::uint32_t a, std::uint32_t b) { return all[a] == all[b]; };
  fit.loose.erase(std::unique(fit.loose.begin(), fit.loose.end(), same), fit.loose.end());
  if (!all.empty())
    node.leaf = std::make_unique<LeafNode<Dim>>(LeafNode<Dim>{{all.begin(), all.end()}, std::move(fit.patches), std::move(fit.loose)});
  return true;
}

template <int Dim>
std::unique_ptr<Proof<Dim>> Tree<Dim>::prove(const SiteView<Dim>& sites, const Cell<Dim>& cell) const {
  if (sites.size() < kProofPoints || static_cast<std::int64_t>(sites.size()) < rules_.min_points) return nullptr;
  return Proof<Dim>::find(sites, cell, eta_ / rules_.snap.step());
}

/// Of all patches below a node [m].
template <int Dim>
Box<Dim> Tree<Dim>::bounds(const Node<Dim>& node) const {
  Box<Dim> box;
  if (node.inner)
    for (const Node<Dim>& child : node.inner->children) box.extend(bounds(child));
  if (node.leaf) {
    for (const Patch<Dim>& patch : node.leaf->patches) box.extend(patch.bounds());
    for (const std::uint32_t i : node.leaf->loose) box.extend(loose_patch<Dim>(node.leaf->sites[i], rules_).vertices[0]);
  }
  return box;
}

template <int Dim>
Totals Tree<Dim>::totals(const Node<Dim>& node, const Cell<Dim>& cell) const {
  if (node.inner) return node.inner->totals;
  Totals totals;
  totals.nodes = totals.leaves = 1;
  totals.depth = cell.depth();
  if (!node.leaf) return totals;
  const LeafNode<Dim>& leaf = *node.leaf;
  totals.points = static_cast<std::int64_t>(leaf.sites.size());
  totals.loose = static_cast<std::int64_t>(leaf.loose.size());
  if (totals.loose > 0) totals.data_to_surface = totals.surface_to_data = loose_patch<Dim>(leaf.sites[leaf.loose[0]], rules_).data_to_surface;
  for (const Patch<Dim>& patch : leaf.patches) {
    std::int64_t& kind = patch.rank() == Dim - 1 ? totals.fits : patch.rank() == 0 ? totals.loose : totals.segments;
    ++kind;
    totals.data_to_surface = std::max(totals.data_to_surface, patch.data_to_surface);
    totals.surface_to_data = std::max(totals.surface_to_data, patch.surface_to_data);
  }
  return totals;
}

template <int Dim>
Moments<Dim> Tree<Dim>::moments_of(const Node<Dim>& node, const Cell<Dim>& cell) const {
  if (node.inner) return node.inner->moments;
  return node.leaf ? moments<Dim>(node.leaf->sites, cell.low, cell.bits) : Moments<Dim>{};
}

template <int Dim>
void Tree<Dim>::sum_up(InnerNode<Dim>& inner, const Cell<Dim>& cell) const {
  inner.totals = {};
  inner.totals.nodes = 1;
  for (int c = 0; c < Cell<Dim>::kChildren; ++c) inner.totals.add(totals(inner.children[c], cell.child(c)));
}

template class Tree<2>;
template class Tree<3>;

}  // namespace vantage
