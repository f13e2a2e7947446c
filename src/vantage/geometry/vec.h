// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <limits>

namespace vantage {

/// Dimension of the world: 2 or 3. The only template parameter of library types.
template <int Dim>
concept SpatialDim = (Dim == 2 || Dim == 3);

/// Position or direction [m] or [1].
template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;

/// Integer lattice coordinates.
template <int Dim>
using Index = Eigen::Matrix<std::int32_t, Dim, 1>;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kPi = 3.14159265358979323846;

}  // namespace vantage
