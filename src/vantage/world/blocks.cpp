// SPDX-License-Identifier: Apache-2.0
#include "vantage/world/blocks.h"

#include <algorithm>

#include "vantage/field/grid.h"

namespace vantage {
namespace {

constexpr double kMerge = 1e-3;  // Faces nearer than this are one, so that chance leaves no slivers [m].
constexpr std::uint32_t kNone = 0xffffffff;

/// Position of `value` among sorted `cuts`.
std::int32_t cut_of(const std::vector<double>& cuts, double value) {
  return static_cast<std::int32_t>(std::lower_bound(cuts.begin(), cuts.end(), value - kMerge) - cuts.begin());
}

/// The rectilinear cells between the faces of all boxes, and which of them are solid.
template <int Dim>
struct Cells {
  std::array<std::vector<double>, Dim> cuts;
  Grid<Dim> grid;
  std::vector<char> solid;

  [[nodiscard]] bool is_solid(const Index<Dim>& cell) const { return grid.inside(cell) && solid[grid.linear(cell)] != 0; }
  void paint(const Box<Dim>& box, bool value) {
    Grid<Dim> range = grid;
    for (int a = 0; a < Dim; ++a) {
      const auto& cut = cuts[static_cast<std::size_t>(a)];
      range.first[a] = cut_of(cut, box.low[a]);
      range.extent[a] = cut_of(cut, box.high[a]) - range.first[a];
    }
    for (std::size_t i = 0; i < range.size(); ++i) solid[grid.linear(range.first + range.local(i))] = value ? 1 : 0;
  }
};

template <int Dim>
class Surface {
 public:
  Surface(const Cells<Dim>& cells, Mesh<Dim>& mesh, const Placement<Dim>& place) : cells_(cells), mesh_(mesh), place_(place) {
    nodes_.extent = cells.grid.extent.array() + 1;
    vertex_.assign(nodes_.size(), kNone);
  }

  /// Face of a cell across `axis`, on its high or low side. The face, a cube of dimension Dim - 1, falls into one simplex for each order of its
  /// axes (Kuhn): all go from its lowest to its highest corner.
  void add_face(const Index<Dim>& cell, int axis, bool high) {
    std::vector<int> order;
    for (int a = 0; a < Dim; ++a)
      if (a != axis) order.push_back(a);
    bool outward = high == (axis % 2 == 0);
    do {
      Index<Dim> node = cell;
      if (high) ++node[axis];
      typename Mesh<Dim>::Facet facet;
      facet[0] = vertex(node);
      for (int i = 0; i + 1 < Dim; ++i) {
        ++node[order[static_cast<std::size_t>(i)]];
        facet[static_cast<std::size_t>(i + 1)] = vertex(node);
      }
      if (!outward) std::swap(facet[Dim - 2], facet[Dim - 1]);
      mesh_.facets.push_back(facet);
      outward = !outward;
    } while (std::next_permutation(order.begin(), order.end()));
  }

 private:
  std::uint32_t vertex(const Index<Dim>& node) {
    std::uint32_t& v = vertex_[nodes_.linear(node)];
    if (v == kNone) {
      Vec<Dim> p;
      for (int a = 0; a < Dim; ++a) p[a] = cells_.cuts[static_cast<std::size_t>(a)][static_cast<std::size_t>(node[a])];
      v = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(place_(p));
    }
    return v;
  }

  const Cells<Dim>& cells_;
  Mesh<Dim>& mesh_;
  Placement<Dim> place_;
  Grid<Dim> nodes_;                    ///< Corners of the cells.
  std::vector<std::uint32_t> vertex_;  ///< Of each of them, kNone if not met yet.
};

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Blocks<Dim>& Blocks<Dim>::fill(const Box<Dim>& box) {
  if (!box.empty()) steps_.push_back({box, true});
  return *this;
}

template <int Dim>
  requires SpatialDim<Dim>
Blocks<Dim>& Blocks<Dim>::carve(const Box<Dim>& box) {
  if (!box.empty()) steps_.push_back({box, false});
  return *this;
}

template <int Dim>
  requires SpatialDim<Dim>
void Blocks<Dim>::append_to(Mesh<Dim>& mesh, const Placement<Dim>& place) const {
  if (steps_.empty()) return;
  Cells<Dim> cells;
  for (int a = 0; a < Dim; ++a) {
    std::vector<double>& cuts = cells.cuts[static_cast<std::size_t>(a)];
    for (const Step& step : steps_) cuts.insert(cuts.end(), {step.box.low[a], step.box.high[a]});
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [](double x, double y) { return y - x < kMerge; }), cuts.end());
    cells.grid.extent[a] = static_cast<std::int32_t>(cuts.size()) - 1;
  }
  cells.solid.assign(cells.grid.size(), 0);
  for (const Step& step : steps_) cells.paint(step.box, step.solid);

  Surface<Dim> surface(cells, mesh, place);
  for (std::size_t i = 0; i < cells.grid.size(); ++i) {
    if (cells.solid[i] == 0) continue;
    const Index<Dim> cell = cells.grid.local(i);
    for (int a = 0; a < Dim; ++a) {
      if (!cells.is_solid(cell - Index<Dim>::Unit(a))) surface.add_face(cell, a, false);
      if (!cells.is_solid(cell + Index<Dim>::Unit(a))) surface.add_face(cell, a, true);
    }
  }
}

template class Blocks<2>;
template class Blocks<3>;

}  // namespace vantage
