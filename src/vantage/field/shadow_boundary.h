// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vantage/field/field.h"

namespace vantage {

/// A lattice face between a seen node and an unseen one: an element of the boundary of the occlusion set.
template <int Dim>
struct ShadowFace {
  std::size_t seen = 0, unseen = 0;  ///< Linear indices.
  std::uint64_t key = 0;             ///< Its name from step to step; faces are listed in the order of their keys.
  int direction = 0;                 ///< 2 axis + (1 if the unseen node is the lower one).
  Vec<Dim> center;                   ///< [m]
  Vec<Dim> normal;                   ///< Unit normal from the slope of psi around the face, into the seen space.

  /// Unit step from the unseen node to the seen one.
  [[nodiscard]] Vec<Dim> step() const {
    Vec<Dim> e = Vec<Dim>::Zero();
    e[direction / 2] = direction % 2 == 0 ? -1.0 : 1.0;
    return e;
  }
  /// Its share of the smooth boundary's area: that of the face, projected along the normal [m^(Dim-1)].
  [[nodiscard]] double area(double spacing) const {
    double face = std::abs(normal[direction / 2]);
    for (int a = 1; a < Dim; ++a) face *= spacing;
    return face;
  }
};

/// The faces between the seen and the unseen nodes of a belief, in blocks of 8^Dim nodes, kept up to date where something has changed.
/// Four bytes a face, five a block and 24 more where there are faces.
template <int Dim>
  requires SpatialDim<Dim>
class ShadowBoundary {
 public:
  static constexpr std::int32_t kSide = 8;

  ShadowBoundary() = default;
  explicit ShadowBoundary(const Grid<Dim>& window);

  /// psi matters only this near to the boundary [steps].
  static constexpr std::int32_t kReach = 7;

  /// Says that a node (counted from the window's first) has changed: its state, or its psi, which was or is within kReach steps of 0. From any
  /// thread.
  void touch(const Index<Dim>& local);
  /// Lists the faces of what was touched, and of whatever normals ask for it, anew. `psi`: signed distance to the set of the seen nodes [m]. `part`
  /// (as windows are) holds all that was touched. Cost: the blocks touched.
  void renew(const Field<Dim, NodeState>& state, const Field<Dim>& psi, const Grid<Dim>& part);

  /// Calls f(face) block by block.
  template <class F>
  void for_faces(F&& f) const {
    for (std::size_t block = 0; block < slot_.size(); ++block)
      if (slot_[block] != 0)
        for (const Element e : lists_[slot_[block]]) f(unpack(block, e));
  }
  [[nodiscard]] std::size_t size() const { return size_; }  ///< Faces.
  [[nodiscard]] std::size_t bytes() const;                  ///< Memory held.

 private:
  /// A face within its block: 3 bits direction, 9 bits node; the normal's longest component by its axis (2 bits) and sign, the others by eight bits
  /// each, good to 0.2 degrees.
  using Element = std::uint32_t;
  using List = std::vector<Element>;

  [[nodiscard]] ShadowFace<Dim> unpack(std::size_t block, Element element) const;
  [[nodiscard]] List list(const Field<Dim, NodeState>& state, const Field<Dim>& psi, const Index<Dim>& block) const;
  void put(std::size_t block, List list);

  Grid<Dim> window_, blocks_;
  std::vector<std::uint8_t> touched_;  ///< Per block.
  std::vector<std::uint32_t> slot_;    ///< Per block; 0: no faces.
  std::vector<List> lists_;            ///< [0] stays empty.
  std::vector<std::uint32_t> free_;
  std::size_t size_ = 0;
};

}  // namespace vantage
