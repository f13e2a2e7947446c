// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "vantage/geometry/box.h"

namespace vantage {

/// Tree of boxes over things numbered from 0, for exact nearest-thing queries: over points it is a k-d tree, over patches a bounding volume
/// hierarchy. Split at the median of the centres along the longest side. It shares nothing with the surface stage.
template <int Dim>
  requires SpatialDim<Dim>
class BoxTree {
 public:
  /// The nearest thing found so far.
  struct Hit {
    double distance2 = kInfinity;     ///< [m^2]
    std::uint32_t item = 0xffffffff;  ///< None.
  };

  /// `box_of(i)` covers thing i; it is asked during the construction only. At most 2^32 - 2 things. Cost: count * log(count).
  BoxTree(std::size_t count, const std::function<Box<Dim>(std::uint32_t)>& box_of);

  /// The thing of least `distance2(item)` to p, which is never below that of its box; `start` if none is nearer than that. Thread-safe.
  template <class Distance2>
  [[nodiscard]] Hit nearest(const Vec<Dim>& p, Hit start, Distance2&& distance2) const {
    Hit best = start;
    visit(
        p, [&] { return best.distance2; },
        [&](std::uint32_t item) {
          if (const double d2 = distance2(item); d2 < best.distance2) best = {d2, item};
          return true;
        });
    return best;
  }

  /// Is there a thing for which `holds(item)`, among those whose boxes are no farther than `reach` [m] from p? Thread-safe.
  template <class Holds>
  [[nodiscard]] bool any_within(const Vec<Dim>& p, double reach, Holds&& holds) const {
    bool found = false;
    const double bound2 = std::nextafter(reach * reach, kInfinity);
    visit(
        p, [&] { return bound2; },
        [&](std::uint32_t item) {
          found = holds(item);
          return !found;
        });
    return found;
  }

 private:
  struct Node {
    Box<Dim> box;
    std::uint32_t begin = 0, end = 0;  ///< Into `items_`.
    std::uint32_t right = 0;           ///< The left child follows its parent; 0: a leaf.
  };

  /// Calls `look(item)` for the things of nodes nearer than `bound2()`, the nearer child first, while it returns true.
  template <class Bound2, class Look>
  void visit(const Vec<Dim>& p, Bound2&& bound2, Look&& look) const {
    if (nodes_.empty()) return;
    struct Waiting {
      double distance2;
      std::uint32_t node;
    };
    std::array<Waiting, 80> stack;  // One a level at most, and a median split has no more than 33.
    std::size_t size = 0;
    stack[size++] = {distance2_to(0, p), 0};
    while (size > 0) {
      const Waiting top = stack[--size];
      if (!(top.distance2 < bound2())) continue;
      const Node& node = nodes_[top.node];
      if (node.right == 0) {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
          if (!look(items_[i])) return;
        continue;
      }
      Waiting near{distance2_to(top.node + 1, p), top.node + 1}, far{distance2_to(node.right, p), node.right};
      if (far.distance2 < near.distance2) std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
    }
  }
  [[nodiscard]] double distance2_to(std::uint32_t node, const Vec<Dim>& p) const {
    const Box<Dim>& box = nodes_[node].box;
    return (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0).squaredNorm();
  }
  void build(std::uint32_t begin, std::uint32_t end, const std::function<Box<Dim>(std::uint32_t)>& box_of);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace vantage
