// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/select.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/exchange/cover.h"
#include "vantage/exchange/leaf_code.h"
#include "vantage/geometry/hausdorff.h"
#include "vantage/geometry/plane_fit.h"

namespace vantage {
namespace {

constexpr std::size_t kChunk = 512;
constexpr int kRefits = 3;             ///< Fits to the points near the last fit.
constexpr int kMomentBits = 20;        ///< Points are placed to 2^-20 of the cell for the fit.
constexpr double kBelow = 1.0 - 1e-9;  ///< Keeps bounds below the reach after rounding.

/// A plane that may stand for the points of a cell.
template <int Dim>
struct Candidate {
  PlaneLeaf<Dim> plane;
  double surface_to_data = 0.0;
};

template <int Dim>
class PlaneSearch {
 public:
  PlaneSearch(const CloudCells<Dim>& cloud, const ExchangeLattice<Dim>& lattice, double reach, std::span<const std::uint8_t> is_new)
      : cloud_(cloud), lattice_(lattice), reach_(reach), is_new_(is_new) {}

  /// Planes of the cell that holds `range`, or of its descendants.
  void search(const CellRange& range, int level, std::vector<Candidate<Dim>>& out) const {
    if (!is_worth(range, [](std::size_t) { return true; })) return;
    if (std::optional<Candidate<Dim>> found = fit(range, level)) {
      out.push_back(*found);
      return;
    }
    if (level > PlaneLeaf<Dim>::kLowest) cloud_.each_cell(range, level - 1, [&](const CellRange& part) { search(part, level - 1, out); });
  }

 private:
  /// Cells with new points that a plane must serve: fewer are cheaper as sites.
  static constexpr std::size_t kWorth = Dim;
  const CloudCells<Dim>& cloud_;
  const ExchangeLattice<Dim>& lattice_;
  double reach_;
  std::span<const std::uint8_t> is_new_;

  /// Cells of level 0 with new points for which `counts` holds, counted up to kWorth.
  template <class Counts>
  [[nodiscard]] bool is_worth(const CellRange& range, Counts&& counts) const {
    std::size_t count = 0, last = range.end;
    for (std::size_t i = range.begin; i < range.end && count < kWorth; ++i) {
      if (is_new_[i] == 0 || (last < range.end && cloud_.cells()[last] == cloud_.cells()[i]) || !counts(i)) continue;
      ++count;
      last = i;
    }
    return count == kWorth;
  }

  [[nodiscard]] std::optional<Candidate<Dim>> fit(const CellRange& range, int level) const {
    // Too few points for the discs around them to cover two fifths of the cell's face: the plane is hardly smaller.
    double discs = 0.4;
    for (int a = 1; a < Dim; ++a) discs *= lattice_.side(level) / (2.0 * reach_);
    if (static_cast<double>(range.size()) < discs || range.size() < Dim) return std::nullopt;
    const CellNumber<Dim> cell = cloud_.cell_of(range, level);
    std::vector<std::size_t> members(range.size()), around;
    for (std::size_t i = 0; i < members.size(); ++i) members[i] = range.begin + i;
    for (int round = 0; round < kRefits && members.size() >= Dim; ++round) {
      const PlaneLeaf<Dim> plane = through(members, cell, level);
      const PlanePiece<Dim> piece = plane_piece(lattice_, plane);
      if (piece.region.count == 0) return std::nullopt;
      const Patch<Dim> patch = piece_patch(piece);
      const auto carries = [&](std::size_t i) { return distance(patch, cloud_.points()[i]) <= reach_ * kBelow; };
      if (has_near_corners(patch) && is_worth(range, carries)) {
        around.clear();
        cloud_.gather(lattice_.box(cell, level).grown(reach_), around);
        if (const auto radius = covering_radius(piece.region, feet(piece.frame, around), reach_ * kBelow)) return Candidate<Dim>{plane, *radius};
      }
      const std::size_t before = members.size();
      std::erase_if(members, [&](std::size_t i) { return !carries(i); });
      if (members.size() == before) return std::nullopt;
    }
    return std::nullopt;
  }

  /// Is there a point near each corner? Most planes that fail do so here, at little cost.
  [[nodiscard]] bool has_near_corners(const Patch<Dim>& patch) const {
    const auto corners = patch.corners();
    return std::all_of(corners.begin(), corners.end(), [&](const Vec<Dim>& corner) { return cloud_.is_near(corner, reach_); });
  }

  /// The PCA plane through points of a cell, rounded to heights.
  [[nodiscard]] PlaneLeaf<Dim> through(std::span<const std::size_t> members, const CellNumber<Dim>& cell, int level) const {
    const Box<Dim> box = lattice_.box(cell, level);
    const double side = lattice_.side(level), unit = side / (1 << kMomentBits);
    std::vector<Site<Dim>> sites(members.size());
    for (std::size_t i = 0; i < members.size(); ++i)
      for (int a = 0; a < Dim; ++a)
        sites[i][static_cast<std::size_t>(a)] =
            static_cast<std::uint32_t>(std::clamp((cloud_.points()[members[i]][a] - box.low[a]) / unit, 0.0, static_cast<double>(1 << kMomentBits)));
    const Frame<Dim> frame = principal_frame<Dim>(moments<Dim>(sites, Site<Dim>{}, kMomentBits + 1), unit);
    const Vec<Dim> normal = frame.axes.col(Dim - 1);
    PlaneLeaf<Dim> plane{.cell = cell, .level = level};
    normal.cwiseAbs().maxCoeff(&plane.axis);
    const double step = lattice_.spacing / PlaneLeaf<Dim>::kSteps;
    double low = frame.origin[plane.axis];
    for (int i = 1; i < Dim; ++i) {
      const int along = (plane.axis + i) % Dim;
      const double slope = -normal[along] / normal[plane.axis];
      plane.height[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(std::lround(slope * side / step));
      low -= step * plane.height[static_cast<std::size_t>(i)] * frame.origin[along] / side;  // The centroid stays, whatever the rounding.
    }
    plane.height[0] = static_cast<std::int32_t>(std::lround(low / step));
    return plane;
  }

  [[nodiscard]] Feet<Dim - 1> feet(const Frame<Dim>& frame, std::span<const std::size_t> members) const {
    Feet<Dim - 1> out;
    for (const std::size_t i : members) {
      const Vec<Dim> local = frame.local(cloud_.points()[i]);
      for (int a = 0; a + 1 < Dim; ++a) out.at[static_cast<std::size_t>(a)].push_back(local[a]);
      out.height2.push_back(local[Dim - 1] * local[Dim - 1]);
    }
    return out;
  }
};

/// Rounding of coordinates, in decoding and in measuring, is below this share of their size.
constexpr double kRounding = 1e-14;

template <int Dim>
std::vector<Candidate<Dim>> search_planes(const CloudCells<Dim>& cloud, const Published<Dim>& published, std::span<const std::uint8_t> is_new) {
  const PlaneSearch<Dim> search(cloud, published.lattice(), published.reach(), is_new);
  std::vector<CellRange> tops;
  cloud.each_cell(cloud.all(), PlaneLeaf<Dim>::kHighest, [&](const CellRange& range) { tops.push_back(range); });
  std::vector<std::vector<Candidate<Dim>>> parts(tops.size());
  parallel_for(tops.size(), 1, [&](std::size_t i) { search.search(tops[i], PlaneLeaf<Dim>::kHighest, parts[i]); });
  std::vector<Candidate<Dim>> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

template <int Dim>
Novelty<Dim> select_leaves(const CloudCells<Dim>& cloud, Published<Dim>& published) {
  const std::vector<Vec<Dim>>& points = cloud.points();
  const ExchangeLattice<Dim>& lattice = published.lattice();
  Novelty<Dim> out;
  std::vector<double> apart(points.size(), kInfinity);  // To what was published, by now; infinite: beyond the reach.
  const auto measure_rest = [&] {
    parallel_for(points.size(), kChunk, [&](std::size_t i) {
      if (!(apart[i] < kInfinity)) apart[i] = published.distance(points[i]).value_or(kInfinity);
    });
  };
  measure_rest();
  std::vector<std::uint8_t> is_new(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) is_new[i] = apart[i] < kInfinity ? 0 : 1;
  out.new_points = static_cast<std::size_t>(std::count(is_new.begin(), is_new.end(), 1));
  for (const Candidate<Dim>& found : search_planes<Dim>(cloud, published, is_new)) {
    out.leaves.planes.push_back(found.plane);
    out.surface_to_data = std::max(out.surface_to_data, found.surface_to_data);
  }
  published.add(out.leaves);
  measure_rest();
  std::vector<Vec<Dim>> rest;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!(apart[i] < kInfinity)) rest.push_back(points[i]);
  Cover<Dim> sites = cover<Dim>(lattice, rest, published.reach() * kBelow);
  out.leaves.sites = std::move(sites.leaves);
  out.surface_to_data = std::max(out.surface_to_data, sites.farthest);
  published.add(Leaves<Dim>{{}, out.leaves.sites});
  measure_rest();
  for (const double distance : apart) out.data_to_surface = std::max(out.data_to_surface, distance);
  double size = 0.0;
  for (const Vec<Dim>& p : points) size = std::max(size, p.cwiseAbs().maxCoeff());
  const double slack = kRounding * size;
  out.data_to_surface = points.empty() ? 0.0 : out.data_to_surface + slack;
  out.surface_to_data = points.empty() ? 0.0 : out.surface_to_data + slack;
  sort_leaves(out.leaves);
  return out;
}

template Novelty<2> select_leaves(const CloudCells<2>&, Published<2>&);
template Novelty<3> select_leaves(const CloudCells<3>&, Published<3>&);

}  // namespace vantage
