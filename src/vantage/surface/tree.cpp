// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/tree.h"

#include <algorithm>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// A proof is worth looking for in nodes of so many points, and threads in updates of so many.
constexpr std::size_t kProofPoints = 256;
constexpr std::size_t kParallelPoints = 2048;

/// Sites with others added, or without them; for each its number among the first, or kNewSite. A site with another count is the same.
template <int Dim>
struct Combined {
  std::vector<Site<Dim>> sites;
  std::vector<std::uint32_t> numbers;

  Combined(std::span<const Site<Dim>> old, std::span<const Site<Dim>> others, bool add) {
    sites.reserve(old.size() + (add ? others.size() : 0));
    numbers.reserve(sites.capacity());
    std::size_t j = 0;
    for (std::size_t i = 0; i < old.size(); ++i) {
      for (; j < others.size() && morton_less<Dim>(others[j], old[i]); ++j)
        if (add) append(others[j], kNewSite);
      append(old[i], static_cast<std::uint32_t>(i));
      if (j < others.size() && same_site<Dim>(others[j], old[i])) change_count(count_of(others[j++]), add);
    }
    for (; add && j < others.size(); ++j) append(others[j], kNewSite);
  }
  /// Of the last site, which goes with its last point.
  void change_count(std::uint32_t count, bool add) {
    if (add) return add_count(sites.back(), count);
    if (count_of(sites.back()) == kMostCount) return;  // Nobody knows how many there were.
    if (count_of(sites.back()) > count) {
      sites.back().back() -= count;
    } else {
      sites.pop_back();
      numbers.pop_back();
    }
  }
  void append(const Site<Dim>& site, std::uint32_t number) {
    sites.push_back(site);
    numbers.push_back(number);
  }
};

/// Of the sites below a node, most of them from what inner nodes know.
template <int Dim>
Moments<Dim> moments_below(const Node<Dim>& node, const Cell<Dim>& cell) {
  if (node.leaf) return moments<Dim>(node.leaf->sites, cell.low, cell.bits);
  Moments<Dim> sum;
  if (!node.inner) return sum;
  if (node.inner->moments) return *node.inner->moments;
  for (int c = 0; c < Cell<Dim>::kChildren; ++c) sum.add(moments_below<Dim>(node.inner->children[c], cell.child(c)));
  return sum;
}

template <int Dim>
void set_sites(LeafNode<Dim>& leaf, std::vector<Site<Dim>>&& sites) {
  leaf.sites = std::move(sites);
  leaf.points = 0;
  for (const Site<Dim>& site : leaf.sites) leaf.points += count_of(site);
  auto& loose = leaf.fit.loose;
  const auto same = [&](std::uint32_t a, std::uint32_t b) { return same_place<Dim>(leaf.sites[a], leaf.sites[b]); };
  loose.erase(std::unique(loose.begin(), loose.end(), same), loose.end());
}

}  // namespace

void Totals::add(const Totals& other) {
  points += other.points;
  sites += other.sites;
  nodes += other.nodes;
  leaves += other.leaves;
  fits += other.fits;
  segments += other.segments;
  loose += other.loose;
  beyond_eta += other.beyond_eta;
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
  inner.sharp = false;
  const auto parts = cell.split(sites);
  std::array<Change<Dim>, Cell<Dim>::kChildren> changes;
  parallel_for(Cell<Dim>::kChildren, sites.size() >= kParallelPoints ? 1 : Cell<Dim>::kChildren, [&](std::size_t c) {
    if (!parts[c].empty()) changes[c] = update(inner.children[c], cell.child(static_cast<int>(c)), parts[c], action);
  });
  Change<Dim> change;
  for (const Change<Dim>& part : changes) change.add(part);
  ++change.nodes_touched;
  const std::int64_t before = inner.totals.sites;
  sum_up(inner, cell);
  const std::int64_t few = rules_.paper ? rules_.min_points : static_cast<std::int64_t>(kFewSites) + 1;
  if (inner.proof) {
    const bool stands = action == Action::insert ? inner.proof->survives_adding(sites, cell) : inner.proof->survives_removing(sites);
    if (stands && inner.totals.sites >= few) return change;
    inner.proof.reset();
  }
  GatheredSites<Dim> all{SiteView<Dim>(node)};
  inner.proof = prove(all.view(), cell);
  if (inner.proof) {
    inner.refusal.reset();
    inner.moments.reset();
    return change;
  }
  const bool all_new = inner.totals.sites - before == static_cast<std::int64_t>(sites.size());
  if (inner.moments && all_new) {
    inner.moments->add(moments<Dim>(sites, cell.low, cell.bits));
  } else {
    inner.moments.reset();
    inner.moments = std::make_unique<Moments<Dim>>(moments_below<Dim>(node, cell));
  }
  if (inner.refusal && all_new &&
      inner.refusal->holds(principal_frame(*inner.moments, rules_.snap.step()), all.view(), cell, rules_.snap, rules_.limit))
    return change;
  Node<Dim> whole;
  inner.refusal = std::make_unique<Refusal<Dim>>();
  if (set_leaf(whole, cell, all, inner.moments.get(), inner.refusal.get())) {  // Prune.
    change.changed.extend(bounds(node));
    change.changed.extend(bounds(whole));
    node = std::move(whole);
  }
  change.points_read += static_cast<std::int64_t>(all.read());
  return change;
}

template <int Dim>
Change<Dim> Tree<Dim>::update_leaf(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Action action) {
  if (node.leaf && action == Action::insert)
    if (Change<Dim> change; update_standing(*node.leaf, cell, sites, change)) return change;
  const std::span<const Site<Dim>> old = node.leaf ? std::span<const Site<Dim>>(node.leaf->sites) : std::span<const Site<Dim>>();
  Combined<Dim> all(old, sites, action == Action::insert);
  Change<Dim> change;
  if (all.sites.size() == old.size()) {  // Other counts at most.
    if (node.leaf) set_sites(*node.leaf, std::move(all.sites));
    return change;
  }
  change.changed = bounds(node);
  if (node.leaf && action == Action::insert && all.sites.size() <= kFewSites && !rules_.paper) {
    LeafNode<Dim>& leaf = *node.leaf;
    leaf.fit = refit_few<Dim>(all.sites, all.numbers, leaf.fit, cell, rules_);
    leaf.sharp.clear();
    set_sites(leaf, std::move(all.sites));
    change.changed.extend(bounds(node));
    change.nodes_touched = 1;
    change.points_read = static_cast<std::int64_t>(leaf.sites.size());
    return change;
  }
  node = {};
  change.add(build(node, cell, all.sites));
  return change;
}

/// Without reading what is there, but for copying it.
template <int Dim>
bool Tree<Dim>::update_standing(LeafNode<Dim>& leaf, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Change<Dim>& change) const {
  if (!leaf.fit.standing) return false;
  std::vector<Site<Dim>> all;
  all.reserve(leaf.sites.size() + sites.size());
  std::merge(leaf.sites.begin(), leaf.sites.end(), sites.begin(), sites.end(), std::back_inserter(all), morton_less<Dim>);
  if (std::adjacent_find(all.begin(), all.end(), same_site<Dim>) != all.end()) return false;
  const auto next = advance<Dim>(leaf.fit.patches[0], *leaf.fit.standing, sites, cell, rules_);
  if (!next) return false;
  change.changed.extend(leaf.fit.patches[0].bounds());
  change.changed.extend(next->first.bounds());
  change.nodes_touched = 1;
  change.points_read = static_cast<std::int64_t>(sites.size());
  leaf.fit.patches[0] = next->first;
  *leaf.fit.standing = next->second;
  leaf.sharp.clear();
  for (const Site<Dim>& site : sites) leaf.points += count_of(site);
  leaf.sites = std::move(all);
  return true;
}

/// The node rule of Sec. IV.
template <int Dim>
Change<Dim> Tree<Dim>::build(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites) {
  if (sites.empty()) return {};
  Change<Dim> change;
  change.nodes_touched = 1;
  change.points_read = static_cast<std::int64_t>(sites.size());
  GatheredSites<Dim> all{SiteView<Dim>(sites)};
  std::unique_ptr<Proof<Dim>> proof = prove(all.view(), cell);
  std::unique_ptr<Moments<Dim>> sums;
  if (!proof && sites.size() > kFewSites) sums = std::make_unique<Moments<Dim>>(moments<Dim>(sites, cell.low, cell.bits));
  auto refusal = sums ? std::make_unique<Refusal<Dim>>() : nullptr;
  if (!proof && set_leaf(node, cell, all, sums.get(), refusal.get())) {
    change.changed = bounds(node);
    return change;
  }
  node.inner = std::make_unique<InnerNode<Dim>>();
  node.inner->proof = std::move(proof);
  node.inner->moments = std::move(sums);
  node.inner->refusal = std::move(refusal);
  const auto parts = cell.split(sites);
  std::array<Change<Dim>, Cell<Dim>::kChildren> changes;
  parallel_for(Cell<Dim>::kChildren, sites.size() >= kParallelPoints ? 1 : Cell<Dim>::kChildren,
               [&](std::size_t c) { changes[c] = build(node.inner->children[c], cell.child(static_cast<int>(c)), parts[c]); });
  for (const Change<Dim>& part : changes) change.add(part);
  sum_up(*node.inner, cell);
  return change;
}

template <int Dim>
std::optional<CellFit<Dim>> Tree<Dim>::fit(GatheredSites<Dim>& sites, const Moments<Dim>* sums, const Cell<Dim>& cell, const FitRules<Dim>& rules,
                                           Refusal<Dim>* refusal) const {
  if (rules.paper && static_cast<std::int64_t>(sites.size()) < rules.min_points) return CellFit<Dim>{};
  auto fit = fit_cell<Dim>(sites, sums, cell, rules, refusal);
  if (!fit && cell.depth() >= max_depth_) fit = fit_at_limit<Dim>(sites.all(), cell, rules);
  return fit;
}

/// False: the cell must be split.
template <int Dim>
bool Tree<Dim>::set_leaf(Node<Dim>& node, const Cell<Dim>& cell, GatheredSites<Dim>& sites, const Moments<Dim>* sums, Refusal<Dim>* refusal) const {
  auto whole = fit(sites, sums, cell, rules_, refusal);
  if (!whole) return false;
  const std::span<const Site<Dim>> all = sites.all();
  if (all.empty()) return true;
  node.leaf = std::make_unique<LeafNode<Dim>>();
  node.leaf->fit = std::move(*whole);
  set_sites(*node.leaf, {all.begin(), all.end()});
  return true;
}

template <int Dim>
void Tree<Dim>::sharpen(Node<Dim>& node, const Cell<Dim>& cell) {
  if (node.leaf) sharpen(*node.leaf, cell);
  if (!node.inner || node.inner->sharp) return;
  InnerNode<Dim>& inner = *node.inner;
  parallel_for(Cell<Dim>::kChildren, inner.totals.sites >= static_cast<std::int64_t>(kParallelPoints) ? 1 : Cell<Dim>::kChildren,
               [&](std::size_t c) { sharpen(inner.children[c], cell.child(static_cast<int>(c))); });
  inner.sharp = true;
}

/// The same fit again, with more patience.
template <int Dim>
void Tree<Dim>::sharpen(LeafNode<Dim>& leaf, const Cell<Dim>& cell) const {
  if (leaf.sharp.size() == leaf.fit.patches.size()) return;
  FitRules<Dim> rules = rules_;
  rules.sharp = true;
  GatheredSites<Dim> sites{SiteView<Dim>(leaf.sites)};
  const auto again = fit(sites, nullptr, cell, rules);
  leaf.sharp.clear();
  for (const Patch<Dim>& patch : again->patches) leaf.sharp.push_back({patch.data_to_surface, patch.surface_to_data});
}

template <int Dim>
std::unique_ptr<Proof<Dim>> Tree<Dim>::prove(const SiteView<Dim>& sites, const Cell<Dim>& cell) const {
  const double cover = rules_.spacing != nullptr ? std::max(eta_, rules_.spacing->most()) : eta_;
  if (sites.size() < kProofPoints || cell.depth() >= max_depth_ || static_cast<std::int64_t>(sites.size()) < rules_.min_points) return nullptr;
  return Proof<Dim>::find(sites, cell, {eta_ / rules_.snap.step(), cover / rules_.snap.step(), rules_.paper ? 2 : 1});
}

/// Of all patches below a node [m].
template <int Dim>
Box<Dim> Tree<Dim>::bounds(const Node<Dim>& node) const {
  Box<Dim> box;
  if (node.inner)
    for (const Node<Dim>& child : node.inner->children) box.extend(bounds(child));
  if (node.leaf) {
    for (const Patch<Dim>& patch : node.leaf->fit.patches) box.extend(patch.bounds());
    for (const std::uint32_t i : node.leaf->fit.loose) box.extend(loose_patch<Dim>(node.leaf->sites[i], rules_).vertices[0]);
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
  totals.points = leaf.points;
  totals.sites = static_cast<std::int64_t>(leaf.sites.size());
  totals.loose = static_cast<std::int64_t>(leaf.fit.loose.size());
  if (totals.loose > 0) totals.data_to_surface = totals.surface_to_data = loose_patch<Dim>(leaf.sites[leaf.fit.loose[0]], rules_).data_to_surface;
  for (const Patch<Dim>& patch : leaf.fit.patches) {
    std::int64_t& kind = patch.rank() == Dim - 1 ? totals.fits : patch.rank() == 0 ? totals.loose : totals.segments;
    ++kind;
    if (patch.surface_to_data > static_cast<float>(eta_)) ++totals.beyond_eta;
    totals.data_to_surface = std::max(totals.data_to_surface, patch.data_to_surface);
    totals.surface_to_data = std::max(totals.surface_to_data, patch.surface_to_data);
  }
  return totals;
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
