// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/published.h"

namespace vantage {

template <int Dim>
void Published<Dim>::add(const Leaves<Dim>& leaves) {
  for (const SiteLeaf<Dim>& leaf : leaves.sites)
    for (const bool center : {false, true})
      if ((leaf.sites >> (center ? 1U : 0U) & 1U) != 0) sites_.insert(site_number<Dim>(leaf.cell, center), 0);
  for (const PlaneLeaf<Dim>& plane : leaves.planes) add_plane(plane);
}

template <int Dim>
void Published<Dim>::add_plane(const PlaneLeaf<Dim>& plane) {
  const PlanePiece<Dim> piece = plane_piece(lattice_, plane);
  if (piece.region.count == 0) return;
  const auto number = static_cast<std::uint32_t>(planes_.size());
  planes_.push_back(piece_patch(piece));
  for (std::size_t i = 0;; ++i) {
    if (i == tables_.size()) tables_.emplace_back();
    if (tables_[i][static_cast<std::size_t>(plane.level)].insert(plane.cell, number)) return;
  }
}

template <int Dim>
std::optional<double> Published<Dim>::distance(const Vec<Dim>& p) const {
  double best = kInfinity;
  each_site_near(lattice_, p, reach_, [&](const CellNumber<Dim>& site, double distance) {
    if (distance < best && sites_.find(site)) best = distance;
  });
  const auto low = lattice_.cell(p.array() - reach_), high = lattice_.cell(p.array() + reach_);
  if (!low || !high) return best <= reach_ ? std::optional(best) : std::nullopt;
  for (const auto& table : tables_)
    for (std::size_t level = PlaneLeaf<Dim>::kLowest; level < kLevels; ++level) {
      if (table[level].size() == 0) continue;
      CellNumber<Dim> first = *low, last = *high;
      for (std::size_t a = 0; a < Dim; ++a) {
        first[a] >>= level;
        last[a] >>= level;
      }
      each_cell_between<Dim>(first, last, [&](const CellNumber<Dim>& cell) {
        if (const auto found = table[level].find(cell)) best = std::min(best, vantage::distance(planes_[*found], p));
      });
    }
  return best <= reach_ ? std::optional(best) : std::nullopt;
}

template class Published<2>;
template class Published<3>;

}  // namespace vantage
