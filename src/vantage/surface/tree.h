// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "vantage/surface/fit.h"
#include "vantage/surface/proof.h"

namespace vantage {

/// Sums over a subtree, by the names of SurfaceStatistics.
struct Totals {
  std::int64_t points = 0, nodes = 0, leaves = 0, fits = 0, segments = 0, loose = 0, dropped = 0;
  int depth = 0;
  float data_to_surface = 0.0F, surface_to_data = 0.0F;

  void add(const Totals& other);
  friend bool operator==(const Totals&, const Totals&) = default;
};

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
  struct Leaf {
    std::vector<Site<Dim>> sites;      ///< In Morton order.
    std::vector<Patch<Dim>> patches;   ///< Fits.
    std::vector<std::uint32_t> loose;  ///< Numbers of the sites that stand for themselves, duplicates once.
    std::int64_t dropped = 0;          ///< Sites without a patch (paper mode).
  };
  struct Inner;
  /// An empty leaf has neither.
  struct Node {
    std::unique_ptr<Leaf> leaf;
    std::unique_ptr<Inner> inner;
  };
  struct Inner {
    std::array<Node, Cell<Dim>::kChildren> children;
    Totals totals;
    std::unique_ptr<Proof<Dim>> proof;  ///< That the cell had to be split; null if that takes reading all its sites.
  };

  Tree(const FitRules<Dim>& rules, double eta, int max_depth) : rules_(rules), eta_(eta), max_depth_(max_depth) {}

  /// Adds sites, or takes out those that are there; they are in Morton order.
  Change<Dim> insert(std::span<const Site<Dim>> sites);
  Change<Dim> remove(std::span<const Site<Dim>> sites);

  [[nodiscard]] Totals totals() const { return totals(root_, Cell<Dim>{}); }
  [[nodiscard]] const Node& root() const { return root_; }
  [[nodiscard]] const FitRules<Dim>& rules() const { return rules_; }

 private:
  enum class Action { insert, remove };

  FitRules<Dim> rules_;
  double eta_;
  int max_depth_;
  Node root_;

  Change<Dim> update(Node& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Action action);
  Change<Dim> update_leaf(Node& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites, Action action);
  Change<Dim> build(Node& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites);
  Change<Dim> split(Node& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites);
  bool set_leaf(Node& node, const Cell<Dim>& cell, std::span<const Site<Dim>> sites) const;
  std::unique_ptr<Proof<Dim>> prove(std::span<const Site<Dim>> sites, const Cell<Dim>& cell) const;
  Box<Dim> bounds(const Node& node) const;
  Totals totals(const Node& node, const Cell<Dim>& cell) const;
  void sum_up(Inner& inner, const Cell<Dim>& cell) const;
};

/// All sites below a node, in Morton order.
template <int Dim>
void gather(const typename Tree<Dim>::Node& node, std::vector<Site<Dim>>& out);

}  // namespace vantage
