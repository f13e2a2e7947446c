// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/nearest.h"

#include <algorithm>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// Patches in a binary tree of boxes, halved at the median of the longest axis.
template <int Dim>
class PatchIndex {
 public:
  explicit PatchIndex(std::vector<Patch<Dim>> patches) : patches_(std::move(patches)) {
    if (!patches_.empty()) build(0, patches_.size());
  }
  /// Distance of p to the nearest patch, or `enough` if it is nearer than that.
  [[nodiscard]] double distance(const Vec<Dim>& p, double enough) const {
    double best = kInfinity;
    if (!nodes_.empty()) descend(0, p, enough, best);
    return std::max(best, enough);
  }

 private:
  struct Node {
    Box<Dim> box;
    std::size_t begin, end, second;  ///< The first child follows its parent; no second: a leaf.
  };
  static constexpr std::size_t kLeaf = 4;
  std::vector<Patch<Dim>> patches_;
  std::vector<Node> nodes_;

  void build(std::size_t begin, std::size_t end) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({{}, begin, end, 0});
    Box<Dim> centers;
    for (std::size_t i = begin; i < end; ++i) {
      nodes_[self].box.extend(patches_[i].bounds());
      centers.extend(patches_[i].bounds().center());
    }
    if (end - begin <= kLeaf) return;
    Eigen::Index axis = 0;
    centers.size().maxCoeff(&axis);
    const std::size_t middle = (begin + end) / 2;
    const auto at = [&](std::size_t i) { return patches_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const Patch<Dim>& a, const Patch<Dim>& b) { return a.bounds().center()[axis] < b.bounds().center()[axis]; });
    build(begin, middle);
    nodes_[self].second = nodes_.size();
    build(middle, end);
  }

  void descend(std::size_t n, const Vec<Dim>& p, double enough, double& best) const {
    const Node& node = nodes_[n];
    if (best <= enough || node.box.distance(p) >= best) return;
    if (node.second == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i) best = std::min(best, vantage::distance(patches_[i], p));
      return;
    }
    const bool swapped = nodes_[node.second].box.distance(p) < nodes_[n + 1].box.distance(p);
    descend(swapped ? node.second : n + 1, p, enough, best);
    descend(swapped ? n + 1 : node.second, p, enough, best);
  }
};

template <int Dim>
void collect(const Node<Dim>& node, const FitRules<Dim>& rules, std::vector<Patch<Dim>>& patches, std::vector<Site<Dim>>& sites) {
  if (node.inner)
    for (const auto& child : node.inner->children) collect<Dim>(child, rules, patches, sites);
  if (!node.leaf) return;
  sites.insert(sites.end(), node.leaf->sites.begin(), node.leaf->sites.end());
  patches.insert(patches.end(), node.leaf->fit.patches.begin(), node.leaf->fit.patches.end());
  for (const std::uint32_t i : node.leaf->fit.loose) patches.push_back(loose_patch<Dim>(node.leaf->sites[i], rules));
}

}  // namespace

template <int Dim>
double farthest_site(const Tree<Dim>& tree) {
  std::vector<Patch<Dim>> patches;
  std::vector<Site<Dim>> sites;
  const Snap<Dim>& snap = tree.rules().snap;
  collect<Dim>(tree.root(), tree.rules(), patches, sites);
  if (sites.empty()) return 0.0;
  if (patches.empty()) return kInfinity;
  const PatchIndex<Dim> index(std::move(patches));
  constexpr std::size_t kChunk = 4096;
  const double largest = parallel_reduce(
      sites.size(), kChunk, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double farthest = 0.0;
        for (std::size_t i = begin; i < end; ++i) farthest = index.distance(snap.world(snap.local(sites[i])), farthest);
        return farthest;
      },
      [](double& joined, double part) { joined = std::max(joined, part); });
  return largest + snap.slack();
}

template double farthest_site<2>(const Tree<2>&);
template double farthest_site<3>(const Tree<3>&);

}  // namespace vantage
