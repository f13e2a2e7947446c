// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "vantage/geometry/box.h"
#include "vantage/geometry/plane_fit.h"

namespace vantage {

/// Order along the Morton curve: total, and every dyadic cell is an interval of it. Bit `a` of a cell's number among its siblings is its side in axis
/// a.
template <int Dim>
[[nodiscard]] inline bool morton_less(const Site<Dim>& a, const Site<Dim>& b) {
  int axis = Dim - 1;
  std::uint32_t most = a[axis] ^ b[axis];
  for (int k = Dim - 2; k >= 0; --k) {
    const std::uint32_t differ = a[k] ^ b[k];
    if (most < differ && most < (most ^ differ)) {  // `differ` has the higher leading bit (Chan 2002).
      most = differ;
      axis = k;
    }
  }
  return a[axis] < b[axis];
}

/// The lattice of 2^32 steps a side over a cube, on which everything that must not depend on the order of the points is decided.
template <int Dim>
  requires SpatialDim<Dim>
class Snap {
 public:
  /// Over the smallest cube that shares `domain`'s centre and covers it.
  explicit Snap(const Box<Dim>& domain);

  /// Nearest site; nullopt outside the cube. `p` is finite.
  [[nodiscard]] std::optional<Site<Dim>> site(const Vec<Dim>& p) const;
  /// Where a site lies, from the cube's low corner [m].
  [[nodiscard]] Vec<Dim> local(const Site<Dim>& site) const;
  [[nodiscard]] Vec<Dim> world(const Vec<Dim>& local) const { return cube_.low + local; }
  [[nodiscard]] const Box<Dim>& cube() const { return cube_; }
  [[nodiscard]] double step() const { return step_; }
  /// No point lies farther from its site, all rounding of coordinates included [m].
  [[nodiscard]] double slack() const;

 private:
  Box<Dim> cube_;
  double step_ = 0.0;
};

/// A site's coordinates in steps.
template <int Dim>
[[nodiscard]] Vec<Dim> lattice_place(const Site<Dim>& site) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = static_cast<double>(site[a]);
  return p;
}

/// Along the Morton curve.
template <int Dim>
void sort_sites(std::vector<Site<Dim>>& sites);

/// A dyadic cell of the lattice: [low, low + 2^bits) in each axis.
template <int Dim>
struct Cell {
  static constexpr int kChildren = 1 << Dim;
  Site<Dim> low{};
  int bits = 32;

  [[nodiscard]] int depth() const { return 32 - bits; }
  [[nodiscard]] Cell child(int number) const {
    Cell out{low, bits - 1};
    for (int a = 0; a < Dim; ++a) out.low[a] |= static_cast<std::uint32_t>((number >> a) & 1) << out.bits;
    return out;
  }
  /// Number of the child that holds `site`.
  [[nodiscard]] int child_of(const Site<Dim>& site) const {
    int number = 0;
    for (int a = 0; a < Dim; ++a) number |= static_cast<int>((site[a] >> (bits - 1)) & 1U) << a;
    return number;
  }
  /// From the cube's low corner, with steps of `step` [m].
  [[nodiscard]] Box<Dim> box(double step) const {
    Box<Dim> box;
    for (int a = 0; a < Dim; ++a) {
      box.low[a] = static_cast<double>(low[a]) * step;
      box.high[a] = box.low[a] + static_cast<double>(std::uint64_t{1} << bits) * step;
    }
    return box;
  }
  /// Cuts sorted sites of the cell at its children.
  [[nodiscard]] std::array<std::span<const Site<Dim>>, kChildren> split(std::span<const Site<Dim>> sites) const;
};

}  // namespace vantage
