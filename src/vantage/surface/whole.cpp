// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/whole.h"

#include <algorithm>
#include <cmath>

#include "vantage/geometry/hausdorff.h"

namespace vantage {
namespace {

constexpr double kTight = 1.1;

/// Calls visit(leaf) for the leaves whose cells meet a box, from the cube's low corner [m].
template <int Dim, class Visit>
void each_leaf_near(const Node<Dim>& node, const Cell<Dim>& cell, const Box<Dim>& box, double step, const Visit& visit) {
  if ((!node.inner && !node.leaf) || cell.box(step).intersection(box).empty()) return;
  if (node.leaf) return visit(*node.leaf);
  for (int c = 0; c < Cell<Dim>::kChildren; ++c) each_leaf_near<Dim>(node.inner->children[c], cell.child(c), box, step, visit);
}

/// The patch in coordinates of its own: the first `Rank` axes span it.
template <int Rank, int Dim>
std::pair<Frame<Dim>, ConvexRegion<Rank>> own_frame(const Patch<Dim>& patch) {
  Frame<Dim> frame;
  frame.origin = patch.vertices[0];
  double longest = 0.0;
  for (int axis = 0; axis < Dim; ++axis) {  // Towards the corner farthest from what is spanned already; if there is none, the unit vector that is.
    Vec<Dim> best = Vec<Dim>::Zero();
    const auto offer = [&](Vec<Dim> way) {
      for (int pass = 0; pass < 2; ++pass)  // Twice is enough for all digits.
        for (int k = 0; k < axis; ++k) way -= frame.axes.col(k) * frame.axes.col(k).dot(way);
      if (way.squaredNorm() > best.squaredNorm()) best = way;
    };
    if (axis < Rank)
      for (const Vec<Dim>& corner : patch.corners()) offer(corner - frame.origin);
    longest = std::max(longest, best.norm());
    if (best.norm() <= 1e-12 * longest)
      for (int k = 0; k < Dim; ++k) offer(Vec<Dim>::Unit(k));
    frame.axes.col(axis) = best / best.norm();
  }
  ConvexRegion<Rank> region;
  for (const Vec<Dim>& corner : patch.corners()) region.vertices[region.count++] = frame.local(corner).template head<Rank>();
  if constexpr (Rank == 2) {
    double turn = 0.0;  // Twice the signed area: corners must go round to the left.
    for (int i = 0; i + 1 < region.count; ++i)
      turn += region.vertices[i][0] * region.vertices[i + 1][1] - region.vertices[i][1] * region.vertices[i + 1][0];
    if (turn < 0.0) std::reverse(region.vertices.begin(), region.vertices.begin() + region.count);
  }
  return {frame, region};
}

template <int Dim>
class Whole {
 public:
  explicit Whole(Tree<Dim>& tree) : tree_(tree), snap_(tree.rules().snap) {
    const Totals totals = tree.totals();
    known_ = {totals.data_to_surface, totals.surface_to_data};
    overhang_ = std::max(known_.data_to_surface, known_.surface_to_data);
  }

  typename LeafNode<Dim>::Sharp errors() {
    for (const Site<Dim>& site : std::array(tree_.telling())) {
      Node<Dim>* node = &tree_.root();
      Cell<Dim> cell;
      while (node->inner) {
        const int child = cell.child_with(site);
        node = &node->inner->children[child];
        cell = cell.child(child);
      }
      if (node->leaf) look_at(*node->leaf, cell);
    }
    look(tree_.root(), {});
    return {data_told() ? known_.data_to_surface : std::min(known_.data_to_surface, rounded(data_)),
            surface_told() ? known_.surface_to_data : std::min(known_.surface_to_data, rounded(surface_))};
  }

 private:
  Tree<Dim>& tree_;
  const Snap<Dim>& snap_;
  typename LeafNode<Dim>::Sharp known_;
  double overhang_ = 0.0;
  double data_ = 0.0, surface_ = 0.0;  ///< The largest so far.

  /// Is the known bound at most a tenth above the truth? What is found of data_to_surface is the truth of a site; of surface_to_data it is a sharp
  /// bound of a patch, itself a tenth above the truth perhaps.
  [[nodiscard]] bool data_told() const { return kTight * data_ >= static_cast<double>(known_.data_to_surface); }
  [[nodiscard]] bool surface_told() const { return surface_ >= (1.0 - 1e-5) * static_cast<double>(known_.surface_to_data); }
  static float rounded(double value) { return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity()); }

  void look(Node<Dim>& node, const Cell<Dim>& cell) {
    if (data_told() && surface_told()) return;
    if (node.inner)
      for (int c = 0; c < Cell<Dim>::kChildren; ++c) look(node.inner->children[c], cell.child(c));
    if (!node.leaf) return;
    look_at(*node.leaf, cell);
  }

  void look_at(LeafNode<Dim>& leaf, const Cell<Dim>& cell) {
    tree_.sharpen(leaf, cell);
    if (!leaf.fit.loose.empty()) {
      data_ = std::max(data_, snap_.slack());
      surface_ = std::max(surface_, snap_.slack());
    }
    double own = 0.0;
    for (const auto& bounds : leaf.sharp) own = std::max(own, static_cast<double>(bounds.data_to_surface));
    if (own > data_ && !data_told()) look_at_sites(leaf);
    for (std::size_t i = 0; i < leaf.fit.patches.size() && !surface_told(); ++i)
      if (const double bound = leaf.sharp[i].surface_to_data; bound > surface_) {
        surface_ = std::max(surface_, farthest_place(leaf.fit.patches[i], bound));
        tree_.telling()[1] = leaf.sites[0];
      }
  }

  double nearest_patch(const LeafNode<Dim>& leaf, const Vec<Dim>& p) const {
    double least = kInfinity;
    for (const Patch<Dim>& patch : leaf.fit.patches) least = std::min(least, distance(patch, p));
    for (const std::uint32_t i : leaf.fit.loose) least = std::min(least, (snap_.world(snap_.local(leaf.sites[i])) - p).norm());
    return least;
  }

  void look_at_sites(const LeafNode<Dim>& leaf) {
    for (const Site<Dim>& site : leaf.sites) {
      if (data_told()) return;
      const Vec<Dim> local = snap_.local(site), p = snap_.world(local);
      double least = nearest_patch(leaf, p);
      if (least + snap_.slack() <= data_) continue;
      const Box<Dim> near = Box<Dim>{local, local}.grown(least + overhang_);
      each_leaf_near<Dim>(tree_.root(), {}, near, snap_.step(),
                          [&](const LeafNode<Dim>& other) { least = std::min(least, nearest_patch(other, p)); });
      if (least + snap_.slack() <= data_) continue;
      data_ = least + snap_.slack();
      tree_.telling()[0] = leaf.sites[0];
    }
  }

  /// surface_to_data of one patch, asked of all sites; `bound` is what its own leave.
  double farthest_place(const Patch<Dim>& patch, double bound) const {
    if (patch.rank() == 0) return bound;
    return patch.rank() == 1 ? farthest_place<1>(patch, bound) : farthest_place<Dim - 1>(patch, bound);
  }
  template <int Rank>
  double farthest_place(const Patch<Dim>& patch, double bound) const {
    const auto [frame, region] = own_frame<Rank, Dim>(patch);
    Feet<Rank> feet;
    Box<Dim> near = patch.bounds().grown(bound);
    near = {near.low - snap_.cube().low, near.high - snap_.cube().low};
    each_leaf_near<Dim>(tree_.root(), {}, near, snap_.step(), [&](const LeafNode<Dim>& leaf) {
      for (const Site<Dim>& site : leaf.sites) {
        if (!near.contains(snap_.local(site))) continue;
        const Vec<Dim> y = frame.local(snap_.world(snap_.local(site)));
        for (int a = 0; a < Rank; ++a) feet.at[a].push_back(y[a]);
        feet.height2.push_back(y.template tail<Dim - Rank>().squaredNorm());
      }
    });
    const auto radius = covering_radius<Rank>(region, feet, kTight * bound);
    return radius ? std::min(bound, *radius + snap_.slack()) : bound;
  }
};

}  // namespace

template <int Dim>
typename LeafNode<Dim>::Sharp whole_errors(Tree<Dim>& tree) {
  return Whole<Dim>(tree).errors();
}

template LeafNode<2>::Sharp whole_errors<2>(Tree<2>&);
template LeafNode<3>::Sharp whole_errors<3>(Tree<3>&);

}  // namespace vantage
