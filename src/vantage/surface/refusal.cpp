// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/refusal.h"

#include <array>
#include <cmath>
#include <functional>

#include "vantage/geometry/angle.h"
#include "vantage/geometry/hausdorff.h"

namespace vantage {
namespace {

constexpr double kCertain = 1.0 + 1e-6;  ///< Of the limit: nearer to it, the plane is tried.

template <int Dim>
using InPlane = Eigen::Matrix<double, Dim - 1, 1>;

template <int Dim>
InPlane<Dim> in_plane(const Vec<Dim>& p, const Frame<Dim>& frame) {
  return frame.local(p).template head<Dim - 1>();
}

/// Of the place of the region nearest to p: is no site within the limit of it?
template <int Dim>
bool is_alone(const ConvexRegion<Dim - 1>& region, const Vec<Dim>& p, const Frame<Dim>& frame, const std::function<bool(const Vec<Dim>&)>& empty) {
  if (region.count == 0) return false;
  const InPlane<Dim> place = region.closest(in_plane<Dim>(p, frame));
  return empty(frame.origin + frame.axes.template leftCols<Dim - 1>() * place);
}

template <int Dim>
Feet<Dim - 1> feet_of(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const Snap<Dim>& snap) {
  Feet<Dim - 1> feet;
  for (const Site<Dim>& site : sites) {
    const Vec<Dim> p = frame.local(snap.local(site));
    for (int a = 0; a < Dim - 1; ++a) feet.at[a].push_back(p[a]);
    feet.height2.push_back(p[Dim - 1] * p[Dim - 1]);
  }
  return feet;
}

}  // namespace

template <int Dim>
bool Refusal<Dim>::holds(const Frame<Dim>& frame, const SiteView<Dim>& sites, const Cell<Dim>& cell, const Snap<Dim>& snap, double limit) const {
  if (off) return std::abs(frame.local(snap.local(*off))[Dim - 1]) > kCertain * limit;
  if (!holes) return false;
  const auto empty = [&](const Vec<Dim>& p) { return is_empty_ball<Dim>(sites, cell, p / snap.step(), kCertain * limit / snap.step()); };
  return is_alone<Dim>(clip_to_box(frame, cell.box(snap.step())), holes->in_cell, frame, empty) &&
         is_alone<Dim>(outline(feet_of<Dim>(holes->extreme, frame, snap)), holes->among, frame, empty);
}

template <int Dim>
std::vector<Site<Dim>> extreme_sites(std::span<const Site<Dim>> sites, const Frame<Dim>& frame, const Snap<Dim>& snap) {
  constexpr int kWays = 2 << (2 * (Dim - 2));  // Every 180 or 45 degrees.
  std::array<InPlane<Dim>, kWays> ways;
  for (int i = 0; i < kWays; ++i) {
    const auto [sine, cosine] = sin_cos(2.0 * kPi * i / kWays);
    ways[i].fill(sine);
    ways[i][0] = cosine;
  }
  std::array<double, kWays> most;
  most.fill(-kInfinity);
  std::vector<Site<Dim>> extreme(kWays);
  for (const Site<Dim>& site : sites) {
    const InPlane<Dim> p = in_plane<Dim>(snap.local(site), frame);
    for (int i = 0; i < kWays; ++i)
      if (const double far = ways[i].dot(p); far > most[i]) {
        most[i] = far;
        extreme[i] = site;
      }
  }
  return extreme;
}

#define VANTAGE_INSTANTIATE(D) \
  template struct Refusal<D>;  \
  template std::vector<Site<D>> extreme_sites<D>(std::span<const Site<D>>, const Frame<D>&, const Snap<D>&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
