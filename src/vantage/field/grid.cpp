// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/grid.h"

#include "vantage/base/error.h"

namespace vantage {

template <int Dim>
Grid<Dim> window_over(const Box<Dim>& box, double spacing) {
  require(!box.empty(), "window over an empty box");
  const Vec<Dim> low = box.low / spacing, high = box.high / spacing;
  require(low.cwiseAbs().maxCoeff() < 1e9 && high.cwiseAbs().maxCoeff() < 1e9, "lattice index beyond 10^9: coarser spacing or smaller domain needed");
  Grid<Dim> grid;
  grid.spacing = spacing;
  for (int a = 0; a < Dim; ++a) {
    grid.first[a] = static_cast<std::int32_t>(std::floor(low[a] + 1e-9));
    grid.extent[a] = static_cast<std::int32_t>(std::ceil(high[a] - 1e-9)) - grid.first[a] + 1;
  }
  return grid;
}

template <int Dim>
Grid<Dim> intersection(const Grid<Dim>& a, const Grid<Dim>& b) {
  Grid<Dim> out = a;
  out.first = a.first.cwiseMax(b.first);
  const Index<Dim> end = (a.first + a.extent).cwiseMin(b.first + b.extent);
  out.extent = (end - out.first).cwiseMax(0);
  return out;
}

template <int Dim>
Grid<Dim> padded(const Grid<Dim>& window, int nodes) {
  Grid<Dim> out = window;
  out.first.array() -= nodes;
  out.extent.array() += 2 * nodes;
  return out;
}

template Grid<2> window_over<2>(const Box<2>&, double);
template Grid<3> window_over<3>(const Box<3>&, double);
template Grid<2> intersection<2>(const Grid<2>&, const Grid<2>&);
template Grid<3> intersection<3>(const Grid<3>&, const Grid<3>&);
template Grid<2> padded<2>(const Grid<2>&, int);
template Grid<3> padded<3>(const Grid<3>&, int);

}  // namespace vantage
