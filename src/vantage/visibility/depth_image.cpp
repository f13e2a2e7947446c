// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/depth_image.h"

#include <algorithm>

namespace vantage {

template <int Dim>
  requires SpatialDim<Dim>
DepthImage<Dim>::DepthImage(int resolution, float far) : resolution_(resolution) {
  std::size_t pixels = 2 * Dim;
  for (int k = 1; k < Dim; ++k) pixels *= static_cast<std::size_t>(resolution);
  ranges_.assign(pixels, far);
}

template <int Dim>
  requires SpatialDim<Dim>
std::size_t DepthImage<Dim>::pixel(const Vec<Dim>& direction) const {
  int axis = 0;
  for (int a = 1; a < Dim; ++a)
    if (std::abs(direction[a]) > std::abs(direction[axis])) axis = a;
  const double major = std::abs(direction[axis]);
  auto index = static_cast<std::size_t>(2 * axis + (direction[axis] < 0.0 ? 1 : 0));
  for (int k = 1; k < Dim; ++k) {
    const double w = direction[(axis + k) % Dim] / major;
    index = index * static_cast<std::size_t>(resolution_) +
            static_cast<std::size_t>(std::clamp(static_cast<int>((w + 1.0) * 0.5 * resolution_), 0, resolution_ - 1));
  }
  return index;
}

template <int Dim>
  requires SpatialDim<Dim>
Vec<Dim> DepthImage<Dim>::place(std::size_t pixel) const {
  const auto face = static_cast<int>(pixel / pixels_per_face());
  const int axis = face / 2;
  Vec<Dim> d;
  d[axis] = face % 2 == 0 ? 1.0 : -1.0;
  for (int k = Dim - 1; k >= 1; --k) {
    d[(axis + k) % Dim] = (static_cast<double>(pixel % static_cast<std::size_t>(resolution_)) + 0.5) * 2.0 / resolution_ - 1.0;
    pixel /= static_cast<std::size_t>(resolution_);
  }
  return d;
}

template <int Dim>
  requires SpatialDim<Dim>
PixelRun<Dim> DepthImage<Dim>::run(std::size_t pixel) const {
  const auto axis = static_cast<int>(pixel / pixels_per_face()) / 2, last = (axis + Dim - 1) % Dim;
  PixelRun<Dim> run{place(pixel), Vec<Dim>::Unit(last), static_cast<double>(pixel % static_cast<std::size_t>(resolution_)) + 0.5,
                    static_cast<double>(resolution_)};
  run.base[last] = 0.0;
  return run;
}

template <int Dim>
  requires SpatialDim<Dim>
typename DepthImage<Dim>::Rectangle DepthImage<Dim>::rectangle(int face, const Box<Dim>& box) const {
  const int axis = face / 2;
  const double near = face % 2 == 0 ? box.low[axis] : -box.high[axis], far = face % 2 == 0 ? box.high[axis] : -box.low[axis];
  Rectangle out;
  out.low.setZero();
  out.high.setZero();
  if (far <= 0.0) return out;
  for (int k = 1; k < Dim; ++k) {
    const double low = box.low[(axis + k) % Dim], high = box.high[(axis + k) % Dim];
    if (low > far || high < -far) return out;
    const double from = low >= 0.0 ? low / far : near > 0.0 ? std::max(low / near, -1.0) : -1.0;
    const double to = high <= 0.0 ? high / far : near > 0.0 ? std::min(high / near, 1.0) : 1.0;
    out.low[k - 1] = std::clamp(static_cast<int>(std::floor((from + 1.0) * 0.5 * resolution_)), 0, resolution_ - 1);
    out.high[k - 1] = std::clamp(static_cast<int>(std::floor((to + 1.0) * 0.5 * resolution_)), 0, resolution_ - 1) + 1;
  }
  return out;
}

template class DepthImage<2>;
template class DepthImage<3>;

}  // namespace vantage
