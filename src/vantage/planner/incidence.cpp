// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/incidence.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/geometry/angle.h"
#include "vantage/planner/regions.h"
#include "vantage/scan/range_image.h"

namespace vantage {
namespace {

/// Unit normal of the surface at a node, to the seen side: away from obstacles, towards what was seen, two cells around; beyond the window all goes
/// on as at its border. Zero if they balance.
template <int Dim>
Vec<Dim> normal_at(const BeliefView<Dim>& view, const Index<Dim>& node) {
  constexpr int kReach = 2, kSide = 2 * kReach + 1;
  const Grid<Dim>& grid = view.window();
  Vec<Dim> sum = Vec<Dim>::Zero();
  int all = 1;
  for (int a = 0; a < Dim; ++a) all *= kSide;
  for (int code = 0; code < all; ++code) {
    Index<Dim> offset;
    for (int a = 0, rest = code; a < Dim; ++a, rest /= kSide) offset[a] = rest % kSide - kReach;
    const Index<Dim> other = (node + offset).cwiseMax(0).cwiseMin((grid.extent.array() - 1).matrix());
    const NodeState state = view.state.at(other);
    if (state == NodeState::unseen) continue;
    sum += (state == NodeState::seen ? 1.0 : -1.0) * offset.template cast<double>();
  }
  return sum.norm() > 0.0 ? Vec<Dim>(sum.normalized()) : sum;
}

int row_of(const ScanPattern&, const Vec<2>&) { return 0; }
int row_of(const ScanPattern& pattern, const Vec<3>& p) {
  return static_cast<int>(std::floor((angle_of(p[2], p.head<2>().norm()) - pattern.elevation(0)) / pattern.step + 0.5));
}

/// Whether a ray next to the direction of the piece, which is given in the sensor's frame, ends on its plane.
template <int Dim>
bool looked_at(const RangeImage<Dim>& image, const ScanPattern& pattern, const SurfacePiece<Dim>& piece, double h) {
  const double reach = piece.center.norm(), slack = h + reach * pattern.step;
  const double azimuth = angle_of(piece.center[1], piece.center[0]);
  const auto column = static_cast<int>(std::floor((azimuth - pattern.azimuth(0)) / pattern.step + 0.5));
  const int row = row_of(pattern, piece.center);
  for (int c = column - 1; c <= column + 1; ++c)
    for (int r = row - 1; r <= row + 1; ++r) {
      const int i = image.index(c, r);
      if (image.range(i) == kInfinity) continue;
      const Vec<Dim> off = image.point(i) - piece.center;
      if (std::abs(off.dot(piece.normal)) <= slack && off.norm() <= 0.25 * reach + h) return true;
    }
  return false;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
Incidence<Dim>::Incidence(const BeliefView<Dim>& view) : window_(view.window()) {
  const double h = window_.spacing;
  double face = 1.0;
  for (int a = 1; a < Dim; ++a) face *= h;
  for (std::size_t i = 0; i < window_.size(); ++i) {
    if (!view.seen(i) || static_cast<double>(view.known_distance[i]) > 1.01 * h) continue;
    const Index<Dim> node = window_.local(i);
    const Vec<Dim> normal = normal_at(view, node);
    for (int side = 0; side < 2 * Dim; ++side) {
      Index<Dim> step = Index<Dim>::Zero();
      step[side / 2] = side % 2 == 0 ? -1 : 1;
      const double area = face * std::abs(normal[side / 2]);
      if (area == 0.0 || !window_.inside(node + step) || view.state.at(node + step) != NodeState::obstacle) continue;
      pieces_.push_back({window_.position(i) + 0.5 * h * step.template cast<double>(), normal, area});
    }
  }
  best_.assign(pieces_.size(), -1.0);
}

template <int Dim>
  requires SpatialDim<Dim>
void Incidence<Dim>::add(const Scan<Dim>& scan) {
  const RangeImage<Dim> image(scan);
  parallel_for(pieces_.size(), 256, [&](std::size_t i) {
    const Vec<Dim> offset = scan.origin - pieces_[i].center;
    const double cosine = offset.norm() > 0.0 ? std::abs(offset.dot(pieces_[i].normal)) / offset.norm() : 1.0;
    if (cosine <= best_[i]) return;
    const auto turn = scan.world_from_sensor.transpose();
    const SurfacePiece<Dim> local{-(turn * offset), turn * pieces_[i].normal, pieces_[i].area};
    if (looked_at(image, scan.pattern, local, window_.spacing)) best_[i] = cosine;
  });
}

template <int Dim>
  requires SpatialDim<Dim>
FlatSurface<Dim> Incidence<Dim>::flatter(double least) const {
  FlatSurface<Dim> flat;
  std::vector<std::size_t> node_of;
  std::vector<double> cosine;
  Field<Dim, std::uint8_t> member(window_);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Index<Dim> node = window_.nearest(pieces_[i].center);
    if (best_[i] < 0.0 || best_[i] >= least || !window_.inside(node)) continue;
    flat.pieces.push_back(pieces_[i]);
    flat.area += pieces_[i].area;
    node_of.push_back(window_.linear(node));
    cosine.push_back(best_[i]);
    member[node_of.back()] = 1;
  }
  const Regions<Dim> regions(window_, [&](std::size_t first, std::span<std::uint8_t> row) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = member[first + k];
  });
  flat.regions.resize(regions.count());
  for (std::size_t i = 0; i < flat.pieces.size(); ++i) {
    FlatRegion<Dim>& region = flat.regions[static_cast<std::size_t>(regions.region_of(node_of[i]))];
    region.area += flat.pieces[i].area;
    region.incidence += flat.pieces[i].area * angle_of(std::sqrt(std::max(0.0, 1.0 - cosine[i] * cosine[i])), cosine[i]);
    region.box.extend(flat.pieces[i].center);
  }
  double smallest = 1.0;
  for (int a = 1; a < Dim; ++a) smallest *= 3.0 * window_.spacing;
  std::erase_if(flat.regions, [&](const FlatRegion<Dim>& region) { return region.area < smallest; });
  for (FlatRegion<Dim>& region : flat.regions) region.incidence /= region.area;
  std::stable_sort(flat.regions.begin(), flat.regions.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
  return flat;
}

template class Incidence<2>;
template class Incidence<3>;

}  // namespace vantage
