// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/depth_image.h"

#include <algorithm>

#include "vantage/base/parallel.h"

namespace vantage {
namespace {

/// Column and row, as real numbers, of a direction in the sensor frame; row 0 in 2D.
template <int Dim>
std::array<double, 2> image_place(const ScanPattern& pattern, const Vec<Dim>& d) {
  const double azimuth = angle_of(d[1], d[0]);
  const double column =
      pattern.full_circle() ? (azimuth + kPi) / (2.0 * kPi) * pattern.columns() : azimuth / pattern.step + 0.5 * (pattern.columns() - 1);
  const double height = (Dim - 2) * d[Dim - 1];
  const double elevation = angle_of(height, d.template head<2>().norm());
  return {column, elevation / pattern.step + 0.5 * (pattern.rows<Dim>() - 1)};
}

/// Free range along a ray for the nodes near it.
float free_range(float range, double max_range) {
  if (std::isnan(range)) return 0.0F;
  return std::isinf(range) ? static_cast<float>(max_range) : range;
}

template <int Dim>
float least_of_neighbours(const Scan<Dim>& scan, const Vec<Dim>& direction) {
  const ScanPattern& pattern = scan.pattern;
  const int columns = pattern.columns(), rows = pattern.rows<Dim>();
  const auto [column, row] = image_place<Dim>(pattern, scan.world_from_sensor.transpose() * direction);
  const bool wraps = pattern.full_circle();
  constexpr double kHalf = 0.5 + 1e-9;  // A ray stands for half a step on each side.
  if (!wraps && (column < -kHalf || column > columns - 1 + kHalf)) return 0.0F;
  if (row < -kHalf || row > rows - 1 + kHalf) return 0.0F;
  const int c0 = static_cast<int>(std::floor(column)), r0 = static_cast<int>(std::floor(row));
  float least = std::numeric_limits<float>::infinity();
  for (const int c : {c0, c0 + 1})
    for (const int r : {r0, r0 + 1}) {
      const int cc = wraps ? (c % columns + columns) % columns : std::clamp(c, 0, columns - 1);
      least = std::min(least, free_range(scan.range(cc, std::clamp(r, 0, rows - 1)), pattern.max_range));
    }
  return least;
}

/// A patch relative to the viewpoint, with what a ray test needs worked out once.
template <int Dim>
struct Occluder {
  Patch<Dim> patch;
  Vec<Dim> center, n;
  double height = 0.0, radius = 0.0;
  std::array<Vec<Dim>, Patch<Dim>::kMaxVertices> edge_normal;
  std::array<double, Patch<Dim>::kMaxVertices> edge_offset;

  Occluder(const Patch<Dim>& source, const Vec<Dim>& origin) : patch(source), center(Vec<Dim>::Zero()), n(Vec<Dim>::Zero()) {
    for (int i = 0; i < patch.count; ++i) center += (patch.vertices[i] -= origin) / patch.count;
    for (const Vec<Dim>& v : patch.corners()) radius = std::max(radius, (v - center).norm());
    if (patch.count < 3) return;
    n = normal(patch);
    height = n.dot(patch.vertices[0]);
    for (int i = 0; i < patch.count; ++i) {
      const Vec<Dim>& a = patch.vertices[i];
      const Vec<Dim> along = patch.vertices[(i + 1) % patch.count] - a, inward = center - a;
      Vec<Dim> outward = along * (along.dot(inward) / std::max(along.squaredNorm(), 1e-300)) - inward;
      outward -= n * n.dot(outward);
      const double length = outward.norm();
      edge_normal[static_cast<std::size_t>(i)] = length > 0.0 ? Vec<Dim>(outward / length) : Vec<Dim>(Vec<Dim>::Zero());
      edge_offset[static_cast<std::size_t>(i)] = edge_normal[static_cast<std::size_t>(i)].dot(a);
    }
  }

  /// Range where `direction` meets the patch widened by `margin`; infinity if it does not. Corners are mitred, at most out to `margin` from
  /// the patch's circumscribed ball.
  [[nodiscard]] double range(const Vec<Dim>& direction, double margin) const {
    if (patch.count < 3) return ray_range<Dim>(patch, Vec<Dim>::Zero(), direction, margin).value_or(kInfinity);
    const double slope = n.dot(direction);
    if (slope == 0.0) return kInfinity;
    const double t = height / slope;
    if (!(t >= 0.0)) return kInfinity;
    const Vec<Dim> q = t * direction;
    if ((q - center).norm() > radius + margin) return kInfinity;
    for (int i = 0; i < patch.count; ++i)
      if (edge_normal[static_cast<std::size_t>(i)].dot(q) - edge_offset[static_cast<std::size_t>(i)] > margin) return kInfinity;
    return t;
  }
};

}  // namespace

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
Vec<Dim> DepthImage<Dim>::direction(std::size_t pixel) const {
  const auto face = static_cast<int>(pixel / pixels_per_face());
  const int axis = face / 2;
  Vec<Dim> d;
  d[axis] = face % 2 == 0 ? 1.0 : -1.0;
  for (int k = Dim - 1; k >= 1; --k) {
    d[(axis + k) % Dim] = (static_cast<double>(pixel % static_cast<std::size_t>(resolution_)) + 0.5) * 2.0 / resolution_ - 1.0;
    pixel /= static_cast<std::size_t>(resolution_);
  }
  return d.normalized();
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

template <int Dim>
void draw_ranges(DepthImage<Dim>& image, const Scan<Dim>& scan) {
  parallel_for(image.size(), 1 << 12, [&](std::size_t p) { image[p] = std::min(image[p], least_of_neighbours(scan, image.direction(p))); });
}

template <int Dim>
void draw_patches(DepthImage<Dim>& image, std::span<const Patch<Dim>> patches, const Vec<Dim>& origin, double margin, double cone_angle) {
  const auto [s, c] = sin_cos(0.5 * cone_angle);
  const double slope = s / c;
  const auto widening = [=](double range) { return margin + range * slope; };
  // Each face of the cube is cut into bands of rows, each drawn by one task: a minimum needs no order.
  constexpr int kBands = 16;
  const int rows = image.resolution();
  const auto area_of = [&](const Patch<Dim>& patch, int face) {
    Box<Dim> box = patch.bounds();
    box.low -= origin;
    box.high -= origin;
    return image.rectangle(face, box.grown(widening(box.center().norm() + 0.5 * box.size().norm())));
  };
  const auto draw = [&](const Occluder<Dim>& occluder, int face, const typename DepthImage<Dim>::Rectangle& area) {
    image.for_pixels(face, area, [&](std::size_t pixel) {
      const Vec<Dim> direction = image.direction(pixel);
      const double range = occluder.range(direction, widening(std::max(0.0, occluder.center.dot(direction))));
      if (range < static_cast<double>(image[pixel])) image[pixel] = static_cast<float>(range);
    });
  };

  using Lists = std::vector<std::vector<std::uint32_t>>;  // Patches that may show in each band.
  const Lists empty(static_cast<std::size_t>(2 * Dim * kBands));
  const Lists lists = parallel_reduce(
      patches.size(), std::size_t{1} << 13, empty,
      [&](std::size_t begin, std::size_t end) {
        Lists part = empty;
        for (std::size_t i = begin; i < end; ++i)
          for (int face = 0; face < 2 * Dim; ++face) {
            const auto area = area_of(patches[i], face);
            if (area.empty()) continue;
            for (int band = area.low[0] * kBands / rows; band * rows / kBands < area.high[0] && band < kBands; ++band)
              part[static_cast<std::size_t>(face * kBands + band)].push_back(static_cast<std::uint32_t>(i));
          }
        return part;
      },
      [](Lists& all, const Lists& part) {
        for (std::size_t t = 0; t < all.size(); ++t) all[t].insert(all[t].end(), part[t].begin(), part[t].end());
      });
  parallel_for(lists.size(), 1, [&](std::size_t task) {
    const int face = static_cast<int>(task) / kBands, band = static_cast<int>(task) % kBands;
    for (const std::uint32_t i : lists[task]) {
      auto area = area_of(patches[i], face);
      area.low[0] = std::max(area.low[0], rows * band / kBands);
      area.high[0] = std::min(area.high[0], rows * (band + 1) / kBands);
      if (!area.empty()) draw(Occluder<Dim>(patches[i], origin), face, area);
    }
  });
}

#define VANTAGE_INSTANTIATE(D)                                  \
  template class DepthImage<D>;                                 \
  template void draw_ranges<D>(DepthImage<D>&, const Scan<D>&); \
  template void draw_patches<D>(DepthImage<D>&, std::span<const Patch<D>>, const Vec<D>&, double, double);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
