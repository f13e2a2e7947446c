// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "vantage/geometry/box.h"
#include "vantage/geometry/plane_fit.h"

namespace vantage {

/// The tag of a site: how many points it stands for, and the number of the scan they are from.
inline constexpr int kCountBits = 20;
inline constexpr std::uint32_t kMostCount = (1U << kCountBits) - 1U, kMostScans = 1U << (32 - kCountBits);
template <class AnySite>
[[nodiscard]] std::uint32_t count_of(const AnySite& site) {
  return site.back() & kMostCount;
}
template <class AnySite>
[[nodiscard]] std::uint32_t scan_of(const AnySite& site) {
  return site.back() >> kCountBits;
}

/// Order along the Morton curve: every dyadic cell is an interval of it. Bit `a` of a cell's number among its siblings is its side in axis a. By the
/// first Dim coordinates; equal ones are not less.
template <int Dim, class Numbers>
[[nodiscard]] inline bool curve_less(const Numbers& a, const Numbers& b) {
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

template <int Dim>
[[nodiscard]] bool same_place(const Site<Dim>& a, const Site<Dim>& b) {
  bool same = true;
  for (int axis = 0; axis < Dim; ++axis) same &= a[axis] == b[axis];
  return same;
}

/// The total order of sites: along the curve, those in one place by their scans.
template <int Dim>
[[nodiscard]] inline bool morton_less(const Site<Dim>& a, const Site<Dim>& b) {
  return same_place<Dim>(a, b) ? scan_of(a) < scan_of(b) : curve_less<Dim>(a, b);
}

/// In one place and from one scan: such sites are one, and their counts add up (to kMostCount; there they stay).
template <int Dim>
[[nodiscard]] bool same_site(const Site<Dim>& a, const Site<Dim>& b) {
  return same_place<Dim>(a, b) && scan_of(a) == scan_of(b);
}
template <class AnySite>
void add_count(AnySite& site, std::uint32_t count) {
  site.back() += std::min(count, kMostCount - count_of(site));
}

/// The lattice of 2^32 steps a side over a cube, on which everything that must not depend on the order of the points is decided.
template <int Dim>
  requires SpatialDim<Dim>
class Snap {
 public:
  /// Over the smallest cube that shares `domain`'s centre and covers it. With a `quantum` [m], sites are the centres of cells of that side.
  explicit Snap(const Box<Dim>& domain, double quantum = 0.0);

  /// Nearest site, of one point and scan 0; nullopt outside the cube. `p` is finite.
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
  std::uint32_t quantum_ = 1;  ///< Steps.
};

/// A site's coordinates in steps.
template <int Dim>
[[nodiscard]] Vec<Dim> lattice_place(const Site<Dim>& site) {
  Vec<Dim> p;
  for (int a = 0; a < Dim; ++a) p[a] = static_cast<double>(site[a]);
  return p;
}

/// Along the Morton curve, and makes one of those that are the same.
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
  /// Number of the child that has the site.
  [[nodiscard]] int child_with(const Site<Dim>& site) const {
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
