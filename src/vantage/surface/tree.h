// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "vantage/surface/fit.h"
#include "vantage/surface/proof.h"

namespace vantage {

/// What an update did below a node.
template <int Dim>
struct Change {
  Box<Dim> changed;
  std::int64_t nodes_touched = 0;
  std::int64_t points_read = 0;  ///< By the tests of inner nodes and the rebuilding of leaves.

  void add(const Change& other) {
    changed.extend(other.changed);
    nodes_touched += other.nodes_touched;
    points_read += other.points_read;
  }
};

/// The Hausdorff tree over sites. Which nodes exist and what they hold is a pure function of the multiset of sites: every decision is one of
/// fit_cell's or fit_at_limit's over all the sites of a cell. Proofs only spare the asking.
template <int Dim>
class Tree {
 public:
  Tree(const FitRules<Dim>& rules, double eta, int max_depth) : rules_(rules), eta_(eta), max_depth_(max_depth) {}

  /// Adds sites, or takes out those that are there; they are in Morton order.
  Change<Dim> insert(std::span<const Site<Dim>> sites);
  Change<Dim> remove(std::span<const Site<Dim>> sites);

  /// Works out sharp bounds for all leaves; those of updates only are within the limit. Cost follows what was updated since.
  void sharpen() { sharpen(root_, {}); }
  /// Those of one leaf.
  void sharpen(LeafNode<Dim>& leaf, const Cell<Dim>& cell) const;

  [[nodiscard]] Totals totals() const { return totals(root_, Cell<Dim>{}); }
  [[nodiscard]] const Node<Dim>& root() const { return root_; }
  [[nodiscard]] Node<Dim>& root() { return root_; }
  /// Sites whose leaves told the errors of the whole when they were asked for the last time: the first to be asked the next time.
  [[nodiscard]] std::array<Site<Dim>, 2>& telling() { return telling_; }
  [[nodiscard]] const FitRules<Dim>& rules() const { return rules_; }

 private:
  enum class Action { insert, remove };

  FitRules<Dim> rules_;
  double eta_;
  int max_depth_;
  Node<Dim> root_;
  std::array<Site<Dim>, 2> telling_{};

  Change<Dim> update(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Action action);
  Change<Dim> update_leaf(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Action action);
  Change<Dim> build(Node<Dim>& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites);

  bool set_leaf(Node<Dim>& node, const Cell<Dim>& cell, GatheredSites<Dim>& sites, const Moments<Dim>* moments,
                Refusal<Dim>* refusal = nullptr) const;
  /// nullopt: the cell must be split.
  std::optional<CellFit<Dim>> fit(GatheredSites<Dim>& sites, const Moments<Dim>* moments, const Cell<Dim>& cell, const FitRules<Dim>& rules,
                                  Refusal<Dim>* refusal = nullptr) const;
  void sharpen(Node<Dim>& node, const Cell<Dim>& cell);
  bool update_standing(LeafNode<Dim>& leaf, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Change<Dim>& change) const;
  std::unique_ptr<Proof<Dim>> prove(const SiteView<Dim>& sites, const Cell<Dim>& cell) const;
  Box<Dim> bounds(const Node<Dim>& node) const;
  Totals totals(const Node<Dim>& node, const Cell<Dim>& cell) const;
  void sum_up(InnerNode<Dim>& inner, const Cell<Dim>& cell) const;
};

}  // namespace vantage
