// SPDX-License-Identifier: Apache-2.0
#include "vantage/field/distance.h"

#include "vantage/field/line_tiles.h"
#include "vantage/field/tiled_distance.h"

namespace vantage {
namespace {

/// Squared distances and sites, axis by axis.
template <class Real, int Dim>
class SiteTransform {
 public:
  explicit SiteTransform(const Field<Dim, std::uint8_t>& set) : squares_(set.window, kFarSquare<Real>), sites_(set.window, kNoSite) {
    const Grid<Dim>& grid = set.window;
    for_axes(
        grid, set.values.data(), [&](const Bits& bits, std::size_t row) { line(bits, row); },
        [&](int axis, std::size_t block) {
          const Shape shape{grid.stride(axis), static_cast<std::size_t>(grid.extent[axis])};
          pass(shape, block * shape.stride * shape.length);
        });
  }
  [[nodiscard]] Field<Dim, std::int32_t> take_sites() { return std::move(sites_); }

 private:
  void line(const Bits& bits, std::size_t row) {
    const auto length = static_cast<std::size_t>(squares_.window.extent[0]), first = row * length;
    const auto put = [&](std::size_t begin, std::size_t end, std::size_t site) {
      for (std::size_t i = begin; i < end; ++i) {
        const Real step = static_cast<Real>(i) - static_cast<Real>(site);
        squares_[first + i] = step * step;
        sites_[first + i] = static_cast<std::int32_t>(first + site);
      }
    };
    for_runs(bits, length, [&](std::size_t begin, std::size_t end, bool set) {
      if (set) {
        for (std::size_t i = begin; i < end; ++i) put(i, i + 1, i);
      } else if (begin > 0 || end < length) {
        const std::size_t middle = middle_of_gap(begin, end, length);
        put(begin, middle, begin - 1);
        put(middle, end, end);
      }
    });
  }

  void pass(const Shape& shape, std::size_t at) {
    const LineMinimum<Real> minimum(shape.length);
    const std::size_t size = shape.length * kTileLanes;
    parallel_chunks(shape.stride, kTiles * kTileLanes, [&](std::size_t begin, std::size_t end) {
      Tiles<Real> old_squares(shape, begin, end), squares(shape, begin, end);
      Tiles<std::int32_t> old_sites(shape, begin, end), sites(shape, begin, end);
      old_squares.read(squares_.values.data() + at, shape, begin, end);
      old_sites.read(sites_.values.data() + at, shape, begin, end);
      for (std::size_t t = 0; t < sites.size(); t += size) {
        minimum(old_squares.data() + t, squares.data() + t, sites.data() + t);
        for (std::size_t k = t; k < t + size; ++k)
          sites.data()[k] = old_sites.data()[t + static_cast<std::size_t>(sites.data()[k]) * kTileLanes + (k - t) % kTileLanes];
      }
      for_tile_rows(shape, begin, end, [&](std::size_t node, std::size_t lane, std::size_t count) {
        copy_lanes(squares.data() + lane, squares_.values.data() + at + node, count);
        copy_lanes(sites.data() + lane, sites_.values.data() + at + node, count);
      });
    });
  }

  Field<Dim, Real> squares_;
  Field<Dim, std::int32_t> sites_;
};

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim, std::int32_t> nearest_sites(const Field<Dim, std::uint8_t>& set) {
  if (exact_in_float(set.window)) return SiteTransform<float, Dim>(set).take_sites();
  return SiteTransform<double, Dim>(set).take_sites();
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> distance_to_set(const Field<Dim, std::uint8_t>& set, double cap) {
  return tiled_distance(set, cap);
}

#define VANTAGE_INSTANTIATE(D)                                                     \
  template Field<D, std::int32_t> nearest_sites<D>(const Field<D, std::uint8_t>&); \
  template Field<D> distance_to_set<D>(const Field<D, std::uint8_t>&, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
