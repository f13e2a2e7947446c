// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/stencil.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"

namespace vantage {

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> smooth(Field<Dim> field, int times) {
  const Grid<Dim>& grid = field.window;
  Field<Dim> other(grid);
  for (int pass = 0; pass < times * Dim; ++pass) {
    const int axis = pass % Dim;
    const std::size_t stride = grid.stride(axis), length = static_cast<std::size_t>(grid.extent[axis]);
    // Row by row along axis 0, so that memory is read in order whatever the axis.
    const auto row = static_cast<std::size_t>(grid.extent[0]);
    parallel_for(grid.size() / std::max<std::size_t>(row, 1), 64, [&](std::size_t r) {
      const std::size_t begin = r * row;
      const std::size_t along = begin / stride % length;
      for (std::size_t k = 0; k < row; ++k) {
        const std::size_t i = begin + k, place = axis == 0 ? k : along;
        const float low = place > 0 ? field[i - stride] : field[i];
        const float high = place + 1 < length ? field[i + stride] : field[i];
        other[i] = 0.25F * (low + high) + 0.5F * field[i];
      }
    });
    std::swap(field.values, other.values);
  }
  return field;
}

template <int Dim>
  requires SpatialDim<Dim>
Vec<Dim> gradient(const Field<Dim>& field, const Index<Dim>& node) {
  const Grid<Dim>& grid = field.window;
  const std::size_t i = grid.linear(node);
  Vec<Dim> g = Vec<Dim>::Zero();
  for (int a = 0; a < Dim; ++a) {
    const bool low = node[a] > 0, high = node[a] + 1 < grid.extent[a];
    if (!low && !high) continue;
    const std::size_t stride = grid.stride(a);
    const double rise = static_cast<double>(field[high ? i + stride : i]) - static_cast<double>(field[low ? i - stride : i]);
    g[a] = rise / (grid.spacing * (low && high ? 2.0 : 1.0));
  }
  return g;
}

template <int Dim>
  requires SpatialDim<Dim>
double laplacian(const Field<Dim>& field, const Index<Dim>& node) {
  const Grid<Dim>& grid = field.window;
  const std::size_t i = grid.linear(node);
  double sum = 0.0;
  for (int a = 0; a < Dim; ++a) {
    if (node[a] == 0 || node[a] + 1 == grid.extent[a]) continue;
    const std::size_t stride = grid.stride(a);
    sum += static_cast<double>(field[i - stride]) + static_cast<double>(field[i + stride]) - 2.0 * static_cast<double>(field[i]);
  }
  return sum / (grid.spacing * grid.spacing);
}

double smeared_delta(double value, double epsilon) {
  return std::abs(value) < epsilon ? (1.0 + sin_cos(kPi * value / epsilon)[1]) / (2.0 * epsilon) : 0.0;
}

double printed_delta(double value, double epsilon) { return std::abs(value) < epsilon ? (1.0 + sin_cos(value / epsilon)[1]) / (2.0 * epsilon) : 0.0; }

#define VANTAGE_INSTANTIATE(D)                                   \
  template Field<D> smooth<D>(Field<D>, int);                    \
  template Vec<D> gradient<D>(const Field<D>&, const Index<D>&); \
  template double laplacian<D>(const Field<D>&, const Index<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
