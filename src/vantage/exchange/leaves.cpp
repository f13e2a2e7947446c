// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/leaves.h"

namespace vantage {

template <int Dim>
PlanePiece<Dim> plane_piece(const ExchangeLattice<Dim>& lattice, const PlaneLeaf<Dim>& plane) {
  const Box<Dim> box = lattice.box(plane.cell, plane.level);
  const double side = lattice.side(plane.level), step = lattice.spacing / PlaneLeaf<Dim>::kSteps;
  PlanePiece<Dim> piece;
  Frame<Dim>& frame = piece.frame;
  frame.variance.setZero();
  frame.origin = box.center();
  frame.origin[plane.axis] = box.low[plane.axis] + step * plane.height[0];
  Vec<Dim> normal = Vec<Dim>::Zero();
  normal[plane.axis] = 1.0;
  for (int i = 1; i < Dim; ++i) {  // Gram and Schmidt over the tangents along the other axes.
    const int along = (plane.axis + i) % Dim;
    const double gain = step * plane.height[i];
    frame.origin[plane.axis] += 0.5 * gain;
    normal[along] = -gain / side;
    Vec<Dim> tangent = Vec<Dim>::Zero();
    tangent[along] = 1.0;
    tangent[plane.axis] = gain / side;
    for (int k = 0; k + 1 < i; ++k) tangent -= frame.axes.col(k).dot(tangent) * frame.axes.col(k);
    frame.axes.col(i - 1) = tangent / tangent.norm();
  }
  frame.axes.col(Dim - 1) = normal / normal.norm();
  piece.region = clip_to_box(frame, box).simplified(1e-6 * side);
  if (piece.region.count > Patch<Dim>::kMaxVertices) piece.region.count = 0;
  return piece;
}

template <int Dim>
Patch<Dim> piece_patch(const PlanePiece<Dim>& piece) {
  Patch<Dim> patch;
  for (int i = 0; i < piece.region.count; ++i)
    patch.vertices[static_cast<std::size_t>(patch.count++)] =
        piece.frame.origin + piece.frame.axes.template leftCols<Dim - 1>() * piece.region.vertices[static_cast<std::size_t>(i)];
  return patch;
}

template <int Dim>
std::vector<Patch<Dim>> patches(const ExchangeLattice<Dim>& lattice, const Leaves<Dim>& leaves) {
  std::vector<Patch<Dim>> all;
  for (const PlaneLeaf<Dim>& plane : leaves.planes)
    if (const PlanePiece<Dim> piece = plane_piece(lattice, plane); piece.region.count > 0) all.push_back(piece_patch(piece));
  for (const SiteLeaf<Dim>& leaf : leaves.sites)
    for (const bool center : {false, true})
      if ((leaf.sites >> (center ? 1U : 0U) & 1U) != 0) all.push_back(point_patch<Dim>(lattice.site(leaf.cell, center)));
  return all;
}

template PlanePiece<2> plane_piece(const ExchangeLattice<2>&, const PlaneLeaf<2>&);
template PlanePiece<3> plane_piece(const ExchangeLattice<3>&, const PlaneLeaf<3>&);
template Patch<2> piece_patch(const PlanePiece<2>&);
template Patch<3> piece_patch(const PlanePiece<3>&);
template std::vector<Patch<2>> patches(const ExchangeLattice<2>&, const Leaves<2>&);
template std::vector<Patch<3>> patches(const ExchangeLattice<3>&, const Leaves<3>&);

}  // namespace vantage
