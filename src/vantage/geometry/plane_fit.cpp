// SPDX-License-Identifier: Apache-2.0
#include "vantage/geometry/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace vantage {

template <int Dim>
  requires SpatialDim<Dim>
void Moments<Dim>::add(const Moments& other) {
  count += other.count;
  for (int i = 0; i < Dim; ++i) sum[i] += other.sum[i];
  for (int i = 0; i < kProducts; ++i) product[i] += other.product[i];
}

template <int Dim>
Moments<Dim> moments(std::span<const Site<Dim>> sites, const Site<Dim>& base, int bits) {
  // Sums of a block fit into 64 bits: a product has 2 * bits bits.
  const std::size_t block = std::size_t{1} << std::clamp(64 - 2 * bits, 0, 20);
  Moments<Dim> total;
  for (std::size_t begin = 0; begin < sites.size(); begin += block) {
    std::array<std::uint64_t, Dim> sum{};
    std::array<std::uint64_t, Moments<Dim>::kProducts> product{};
    for (const Site<Dim>& site : sites.subspan(begin, std::min(block, sites.size() - begin))) {
      std::array<std::uint64_t, Dim> x;
      for (int i = 0; i < Dim; ++i) sum[i] += x[i] = site[i] - base[i];
      for (int i = 0, k = 0; i < Dim; ++i)
        for (int j = i; j < Dim; ++j) product[k++] += x[i] * x[j];
    }
    for (int i = 0; i < Dim; ++i) total.sum[i] += sum[i];
    for (int i = 0; i < Moments<Dim>::kProducts; ++i) total.product[i] += product[i];
  }
  total.count = static_cast<std::int64_t>(sites.size());
  for (int i = 0, k = 0; i < Dim; ++i)  // From relative to the base to absolute.
    for (int j = i; j < Dim; ++j, ++k) {
      const WideInt x = base[i], y = base[j];
      total.product[k] += x * total.sum[j] + y * total.sum[i] + total.count * x * y;
    }
  for (int i = 0; i < Dim; ++i) total.sum[i] += static_cast<WideInt>(total.count) * base[i];
  return total;
}

template <int Dim>
Frame<Dim> principal_frame(const Moments<Dim>& m, double step) {
  const double count = static_cast<double>(m.count);
  Frame<Dim> frame;
  Eigen::Matrix<double, Dim, Dim> covariance;
  for (int i = 0, k = 0; i < Dim; ++i) {
    frame.origin[i] = static_cast<double>(m.sum[i]) / count * step;
    for (int j = i; j < Dim; ++j, ++k)
      covariance(i, j) = covariance(j, i) = static_cast<double>(m.count * m.product[k] - m.sum[i] * m.sum[j]) / (count * count);
  }
  // The iterative solver: the closed form loses the small eigenvalue of a flat cloud.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim, Dim>> solver;
  solver.compute(covariance);
  for (int i = 0; i < Dim; ++i) {
    frame.axes.col(i) = solver.eigenvectors().col(Dim - 1 - i);
    frame.variance[i] = std::max(0.0, solver.eigenvalues()[Dim - 1 - i]) * step * step;
  }
  return frame;
}

#define VANTAGE_INSTANTIATE(D)                                                   \
  template struct Moments<D>;                                                    \
  template Moments<D> moments<D>(std::span<const Site<D>>, const Site<D>&, int); \
  template Frame<D> principal_frame<D>(const Moments<D>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
