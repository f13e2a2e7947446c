// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <optional>
#include <vector>

#include "vantage/exchange/cell_table.h"
#include "vantage/geometry/clip.h"
#include "vantage/geometry/patch.h"

namespace vantage {

/// The lattice on which exchanged maps live: cubic cells of side `spacing`, anchored at the world's origin, the same for every vehicle; a
/// body-centred site at each cell's low corner and centre. In space no other lattice covers it with fewer balls (Bambah 1954): every place is within
/// `reach` of a site. Cells are counted from -2^30, so that the dyadic cells of level l, of 2^l cells a side, have numbers >> l.
template <int Dim>
struct ExchangeLattice {
  static constexpr int kDepth = 31;                    ///< Level of the root, which holds everything.
  static constexpr std::uint32_t kOrigin = 1U << 30U;  ///< Number of the cell whose low corner is the world's origin.
  double spacing = 0.0;                                ///< Side of a cell [m].

  /// The coarsest one on which no place is farther than `reach` [m] from a site.
  [[nodiscard]] static ExchangeLattice covering(double reach) { return {(1.0 - 1e-6) * 4.0 / std::sqrt(2.0 * Dim - Dim % 2) * reach}; }

  /// The cell that holds p; nullopt more than 2^29 cells from the origin.
  [[nodiscard]] std::optional<CellNumber<Dim>> cell(const Vec<Dim>& p) const {
    CellNumber<Dim> at;
    for (int a = 0; a < Dim; ++a) {
      const double number = std::floor(p[a] / spacing);
      if (!(std::abs(number) <= static_cast<double>(kOrigin / 2))) return std::nullopt;
      at[a] = static_cast<std::uint32_t>(static_cast<std::int64_t>(number) + kOrigin);
    }
    return at;
  }
  /// Low corner of cell `at` of `level` [m].
  [[nodiscard]] Vec<Dim> corner(const CellNumber<Dim>& at, int level) const {
    Vec<Dim> p;
    for (int a = 0; a < Dim; ++a) p[a] = spacing * static_cast<double>((std::int64_t{at[a]} << level) - kOrigin);
    return p;
  }
  [[nodiscard]] double side(int level) const { return spacing * static_cast<double>(std::int64_t{1} << level); }
  [[nodiscard]] Box<Dim> box(const CellNumber<Dim>& at, int level) const {
    const Vec<Dim> low = corner(at, level);
    return {low, low.array() + side(level)};
  }
  /// Place of the site of cell `at`: its corner, or its centre [m].
  [[nodiscard]] Vec<Dim> site(const CellNumber<Dim>& at, bool center) const { return corner(at, 0).array() + (center ? 0.5 * spacing : 0.0); }
};

/// The plane (in 2D: line) through a cell, as heights over its face: exact integers, so that all who read it have the same one.
template <int Dim>
struct PlaneLeaf {
  static constexpr int kLowest = 1, kHighest = 7;  ///< Levels of cells that may hold one.
  static constexpr int kSteps = 12;                ///< Steps of height in a cell of level 0.

  CellNumber<Dim> cell{};
  std::int32_t level = 0;
  std::int32_t axis = 0;                   ///< Heights are along it; the normal's largest component.
  std::array<std::int32_t, Dim> height{};  ///< At the low corner from the cell's low face, then what it gains across the cell along each other axis.

  friend bool operator==(const PlaneLeaf&, const PlaneLeaf&) = default;
};

/// Sites of one cell.
template <int Dim>
struct SiteLeaf {
  CellNumber<Dim> cell{};
  std::uint8_t sites = 0;  ///< 1: its corner, 2: its centre, 3: both.

  friend bool operator==(const SiteLeaf&, const SiteLeaf&) = default;
};

/// What a delta says: planes from the largest cells to the smallest, and sites; both along the Morton curve.
template <int Dim>
struct Leaves {
  std::vector<PlaneLeaf<Dim>> planes;
  std::vector<SiteLeaf<Dim>> sites;

  friend bool operator==(const Leaves&, const Leaves&) = default;
};

/// A plane's piece in its cell, with the frame it lies in; region.count = 0 if they hardly meet.
template <int Dim>
struct PlanePiece {
  Frame<Dim> frame;
  ConvexRegion<Dim - 1> region;
};
template <int Dim>
[[nodiscard]] PlanePiece<Dim> plane_piece(const ExchangeLattice<Dim>& lattice, const PlaneLeaf<Dim>& plane);

/// Its corners as a patch: a polygon, in 2D a segment.
template <int Dim>
[[nodiscard]] Patch<Dim> piece_patch(const PlanePiece<Dim>& piece);

/// All as patches, planes first.
template <int Dim>
[[nodiscard]] std::vector<Patch<Dim>> patches(const ExchangeLattice<Dim>& lattice, const Leaves<Dim>& leaves);

}  // namespace vantage
