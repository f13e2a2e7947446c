// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/field/field.h"

namespace vantage {

/// One [1 2 1]/4 pass along every axis, repeated `times`; the window's border repeats its outermost values.
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Field<Dim> smooth(Field<Dim> field, int times);

/// Central differences, one-sided at the border [unit of the field per m].
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] Vec<Dim> gradient(const Field<Dim>& field, const Index<Dim>& node);

/// Sum of second differences over the axes; axes at the border count nothing [unit of the field per m^2].
template <int Dim>
  requires SpatialDim<Dim>
[[nodiscard]] double laplacian(const Field<Dim>& field, const Index<Dim>& node);

/// Smeared delta of the level-set literature [7]: (1 + cos(pi value / epsilon)) / (2 epsilon) for |value| < epsilon, else 0 [1/m].
[[nodiscard]] double smeared_delta(double value, double epsilon);
/// The same as printed in Sec. III-A, without pi: it counts up to 85 % too much.
[[nodiscard]] double printed_delta(double value, double epsilon);

}  // namespace vantage
