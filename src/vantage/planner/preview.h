// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <unordered_map>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/opening.h"

namespace vantage {

/// Which rays meet the shadow boundary frontally enough.
template <int Dim>
class Facing {
 public:
  /// `least`: cosine between ray and normal; 0: any.
  Facing(std::span<const BoundaryFace<Dim>> faces, double least);
  [[nodiscard]] bool any() const { return least_ <= 0.0; }
  /// Where a ray of that direction first meets the unseen; over a corner there may be no face.
  [[nodiscard]] bool holds(std::size_t unseen, const Vec<Dim>& direction) const;

 private:
  double least_;
  std::unordered_map<std::size_t, Vec<Dim>> normals_;  // Of unseen nodes that have faces; any length.
};

/// What a scan from a place is expected to show, by straight lines through the lattice.
template <int Dim>
class Preview {
 public:
  struct Medium {
    double opacity = 0.0, range = 0.0;  ///< Of the unseen [1/m]; of the scanner [m].
  };
  /// All must outlive this.
  Preview(const BeliefView<Dim>& view, const Field<Dim>& openness, const Medium& medium, const Facing<Dim>& facing);

  /// The directions along which what is met first is unseen and met frontally enough.
  [[nodiscard]] std::vector<Vec<Dim>> frontal(const Vec<Dim>& from, std::span<const Vec<Dim>> directions) const;
  /// Probability that the unseen node is shown to `from`: that the boundary opens, times what the unseen lets through; 0 behind a known surface.
  [[nodiscard]] double shows(const Vec<Dim>& from, std::size_t node) const;
  /// Lessens what is left of every unseen node by what a scan from `place` will show.
  void take(const Vec<Dim>& place, Field<Dim>& left) const;
  /// Share of known surface in all that is in view: surface and boundary that may open.
  [[nodiscard]] double overlap(const Vec<Dim>& from, std::span<const Vec<Dim>> directions) const;

 private:
  template <class Visit>
  void walk(const Vec<Dim>& from, const Vec<Dim>& direction, double length, Visit&& visit) const;

  const BeliefView<Dim>& view_;
  const Field<Dim>& openness_;
  Grid<Dim> grid_;
  double fade_, range_;
  const Facing<Dim>& facing_;
};

}  // namespace vantage
