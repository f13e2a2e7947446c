// SPDX-License-Identifier: Apache-2.0
#include "vantage/audit/box_tree.h"

#include <algorithm>
#include <numeric>

namespace vantage {
namespace {

constexpr std::uint32_t kLeaf = 8;  ///< Things in a leaf at most.

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
BoxTree<Dim>::BoxTree(std::size_t count, const std::function<Box<Dim>(std::uint32_t)>& box_of) : items_(count) {
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.reserve(count / 3 + 1);
  if (count > 0) build(0, static_cast<std::uint32_t>(count), box_of);
}

template <int Dim>
  requires SpatialDim<Dim>
void BoxTree<Dim>::build(std::uint32_t begin, std::uint32_t end, const std::function<Box<Dim>(std::uint32_t)>& box_of) {
  const std::size_t self = nodes_.size();
  nodes_.push_back({{}, begin, end, 0});
  Box<Dim> box, centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Box<Dim> one = box_of(items_[i]);
    box.extend(one);
    centers.extend(one.center());
  }
  nodes_[self].box = box;
  if (end - begin <= kLeaf) return;
  Eigen::Index axis = 0;
  centers.size().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  // The number decides between equals: the tree is the same on every machine.
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const double x = box_of(a).center()[axis], y = box_of(b).center()[axis];
    return x != y ? x < y : a < b;
  };
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, before);
  build(begin, middle, box_of);
  nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end, box_of);
}

template class BoxTree<2>;
template class BoxTree<3>;

}  // namespace vantage
