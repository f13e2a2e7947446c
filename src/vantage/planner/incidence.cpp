// SPDX-License-Identifier: Apache-2.0
#include "vantage/planner/incidence.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/field/field.h"
#include "vantage/planner/regions.h"
#include "vantage/scan/range_image.h"

namespace vantage {
namespace {

/// A segment or a triangle.
template <int Dim>
using Corners = std::array<Vec<Dim>, Dim>;

/// Halves the longest side until it is at most `most`.
template <int Dim>
void cut(const Corners<Dim>& corners, double most, std::vector<SurfacePiece<Dim>>& pieces) {
  std::size_t from = 0, to = 1;
  for (std::size_t i = 0; i < Dim; ++i)
    for (std::size_t j = i + 1; j < Dim; ++j)
      if ((corners[i] - corners[j]).norm() > (corners[from] - corners[to]).norm()) from = i, to = j;
  if ((corners[from] - corners[to]).norm() > most) {
    Corners<Dim> one = corners, other = corners;
    one[from] = other[to] = 0.5 * (corners[from] + corners[to]);
    cut<Dim>(one, most, pieces);
    cut<Dim>(other, most, pieces);
    return;
  }
  Patch<Dim> patch;
  patch.count = Dim;
  std::copy(corners.begin(), corners.end(), patch.vertices.begin());
  const double area = measure(patch);
  if (!(area > 0.0)) return;
  Vec<Dim> center = Vec<Dim>::Zero();
  for (const Vec<Dim>& p : corners) center += p / Dim;
  pieces.push_back({center, normal(patch), area});
}

double azimuth_of(const Vec<2>& p) { return angle_of(p[1], p[0]); }
double azimuth_of(const Vec<3>& p) { return angle_of(p[1], p[0]); }
double elevation_of(const Vec<2>&) { return 0.0; }
double elevation_of(const Vec<3>& p) { return angle_of(p[2], p.head<2>().norm()); }

/// Whether a ray next to the direction of the piece, which is given in the sensor's frame, ends on its plane.
template <int Dim>
bool looked_at(const RangeImage<Dim>& image, const ScanPattern& pattern, const SurfacePiece<Dim>& piece, double h) {
  const double reach = piece.center.norm(), slack = 0.5 * h + reach * pattern.step;
  const auto column = static_cast<int>(std::floor((azimuth_of(piece.center) - pattern.azimuth(0)) / pattern.step + 0.5));
  const auto row = static_cast<int>(std::floor((elevation_of(piece.center) - pattern.elevation(0)) / pattern.step + 0.5));
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
Incidence<Dim>::Incidence(std::span<const Patch<Dim>> patches, const Grid<Dim>& window) : window_(window) {
  for (const Patch<Dim>& patch : patches) {
    if (patch.rank() != Dim - 1) continue;
    const auto all = patch.corners();
    for (std::size_t i = 1; i + Dim - 1 <= all.size(); ++i) {  // A fan.
      Corners<Dim> corners;
      corners[0] = all[0];
      for (std::size_t k = 1; k < Dim; ++k) corners[k] = all[i + k - 1];
      cut<Dim>(corners, window.spacing, pieces_);
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
