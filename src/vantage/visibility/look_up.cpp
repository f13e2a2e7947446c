// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/look_up.h"

#include <array>

#include "vantage/visibility/lanes.h"

namespace vantage {
namespace {

static_assert(kLanes == SeenSet<3>::kSide);
using Reals = Lanes<double>;
using Pixels = Lanes<std::int32_t>;

/// DepthImage::pixel() along one axis of a face. Lanes that another face answers for may hold anything.
VANTAGE_LANES std::int32_t to_pixel(double w, double resolution) {
  const double t = (w + 1.0) * 0.5 * resolution, last = resolution - 1.0;
  const double low = t < last ? t : last;
  return static_cast<std::int32_t>(low > 0.0 ? low : 0.0);
}

/// Pixels of nodes whose largest offset is along axis 0; `size` is its magnitude.
template <int Dim>
VANTAGE_LANES void pixels_ahead(const LookUp<Dim>& look, const Reals& x, const Reals& size, const std::array<double, Dim>& d, Pixels& pixel) {
  for (int k = 0; k < kLanes; ++k) pixel[k] = x[k] < 0.0 ? 1 : 0;
  for (int j = 1; j < Dim; ++j)
    for (int k = 0; k < kLanes; ++k) pixel[k] = pixel[k] * look.resolution + to_pixel(d[j] / size[k], look.resolution);
}

/// Pixels of nodes whose largest offset is along `axis`, not 0.
template <int Dim>
VANTAGE_LANES void pixels_aside(const LookUp<Dim>& look, const Reals& x, const std::array<double, Dim>& d, int axis, Pixels& pixel) {
  const double size = d[axis] < 0.0 ? -d[axis] : d[axis];
  std::int32_t base = 2 * axis + (d[axis] < 0.0 ? 1 : 0), stride = 1;
  for (int j = 1; j < Dim; ++j) {
    const int a = (axis + j) % Dim;
    base = base * look.resolution + (a == 0 ? 0 : to_pixel(d[a] / size, look.resolution));
    stride = a == 0 ? 1 : stride * look.resolution;
  }
  for (int k = 0; k < kLanes; ++k) pixel[k] = base + stride * to_pixel(x[k] / size, look.resolution);
}

/// The nodes of a block along axis 0.
struct Row {
  Reals x, size;       ///< Offset and its magnitude, above zero [m].
  double least, most;  ///< Of `size`.
};

template <int Dim>
VANTAGE_LANES std::uint8_t row(const LookUp<Dim>& look, const Row& lanes, const std::array<double, Dim>& d) {
  int axis = 1;
  double most = d[1] < 0.0 ? -d[1] : d[1], square = d[Dim - 1] * d[Dim - 1];
  for (int a = Dim - 2; a >= 1; --a) square = d[a] * d[a] + square;
  for (int a = 2; a < Dim; ++a) {
    const double size = d[a] < 0.0 ? -d[a] : d[a];
    axis = size > most ? a : axis;
    most = size > most ? size : most;
  }
  Pixels pixel;
  if (lanes.most < most) {
    pixels_aside<Dim>(look, lanes.x, d, axis, pixel);
  } else if (lanes.least >= most) {
    pixels_ahead<Dim>(look, lanes.x, lanes.size, d, pixel);
  } else {
    Pixels aside;
    pixels_aside<Dim>(look, lanes.x, d, axis, aside);
    pixels_ahead<Dim>(look, lanes.x, lanes.size, d, pixel);
    for (int k = 0; k < kLanes; ++k) pixel[k] = lanes.size[k] < most ? aside[k] : pixel[k];
  }
  Lanes<float> depth;
  for (int k = 0; k < kLanes; ++k) depth[k] = look.ranges[pixel[k]];
  unsigned seen = 0;
  for (int k = 0; k < kLanes; ++k) {
    const double s = lanes.x[k] * lanes.x[k] + square, z = static_cast<double>(depth[k]);
    seen |= static_cast<unsigned>((s <= look.max_square) & ((s <= z * z) | (s == 0.0))) << k;
  }
  return static_cast<std::uint8_t>(seen);
}

template <int Dim>
VANTAGE_LANES void block(const LookUp<Dim>& look, const std::int32_t* first, std::uint8_t* bits) {
  Row lanes;
  for (int k = 0; k < kLanes; ++k) {
    lanes.x[k] = static_cast<double>(first[0] + k) * look.spacing - look.origin.data()[0];
    const double size = lanes.x[k] < 0.0 ? -lanes.x[k] : lanes.x[k];
    lanes.size[k] = size > 1e-300 ? size : 1e-300;
  }
  lanes.least = lanes.most = lanes.size[0];
  for (int k = 1; k < kLanes; ++k) {
    lanes.least = lanes.size[k] < lanes.least ? lanes.size[k] : lanes.least;
    lanes.most = lanes.size[k] > lanes.most ? lanes.size[k] : lanes.most;
  }
  for (int r = 0; r < static_cast<int>(SeenSet<Dim>::kNodes) / kLanes; ++r) {
    std::array<double, Dim> d{};
    for (int a = 1, rest = r; a < Dim; ++a, rest /= kLanes)
      d[a] = static_cast<double>(first[a] + rest % kLanes) * look.spacing - look.origin.data()[a];
    bits[r] = row<Dim>(look, lanes, d);
  }
}

template <int Dim>
void block_anywhere(const LookUp<Dim>& look, const std::int32_t* first, std::uint8_t* bits) {
  block<Dim>(look, first, bits);
}

#if VANTAGE_WIDE
template <int Dim>
VANTAGE_AVX2 void block_avx2(const LookUp<Dim>& look, const std::int32_t* first, std::uint8_t* bits) {
  block<Dim>(look, first, bits);
}
#endif

template <int Dim>
auto best_block() {
#if VANTAGE_WIDE
  if (has_avx2()) return &block_avx2<Dim>;
#endif
  return &block_anywhere<Dim>;
}

}  // namespace

template <int Dim>
typename SeenSet<Dim>::Bits look_up(const LookUp<Dim>& look, const Index<Dim>& first) {
  static const auto work = best_block<Dim>();
  typename SeenSet<Dim>::Bits bits;
  work(look, first.data(), bits.data());
  return bits;
}

template SeenSet<2>::Bits look_up<2>(const LookUp<2>&, const Index<2>&);
template SeenSet<3>::Bits look_up<3>(const LookUp<3>&, const Index<3>&);

}  // namespace vantage
