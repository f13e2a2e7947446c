// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "vantage/base/parallel.h"
#include "vantage/visibility/depth_image.h"
#include "vantage/visibility/depth_pyramid.h"
#include "vantage/visibility/sieve.h"

namespace vantage {
namespace {

constexpr int kBands = 16;  ///< Each face is cut into bands of rows, each drawn by one task: a minimum needs no order.

/// A patch in a band of a face.
template <int Dim>
struct Entry {
  std::uint32_t patch;
  typename DepthImage<Dim>::Rectangle area;
};

template <int Dim>
class PatchDrawer {
 public:
  PatchDrawer(DepthImage<Dim>& image, const Vec<Dim>& origin, double margin, double cone_slope)
      : image_(image), before_(image), origin_(origin), margin_(margin), slope_(cone_slope) {}

  using Lists = std::vector<std::vector<Entry<Dim>>>;  ///< Per face and band.

  [[nodiscard]] static Lists empty_lists() { return Lists(static_cast<std::size_t>(2 * Dim * kBands)); }

  /// Adds a patch to the lists of the bands it may show in: not where all that the image holds already is nearer.
  void sort_in(Lists& lists, const Patch<Dim>& patch, std::uint32_t index) const {
    const int rows = image_.resolution();
    Box<Dim> box = patch.bounds();
    box.low -= origin_;
    box.high -= origin_;
    box = box.grown(widening(farthest(box)));
    const double nearest = box.low.cwiseMax(-box.high).cwiseMax(0.0).norm() * (1.0 - 1e-9);
    for (int face = 0; face < 2 * Dim; ++face) {
      const auto area = image_.rectangle(face, box);
      if (area.empty() || static_cast<double>(before_.over(face, area).high) <= nearest) continue;
      for (int band = area.low[0] * kBands / rows; band < kBands && band * rows / kBands < area.high[0]; ++band) {
        auto part = area;
        part.low[0] = std::max(area.low[0], rows * band / kBands);
        part.high[0] = std::min(area.high[0], rows * (band + 1) / kBands);
        if (!part.empty()) lists[static_cast<std::size_t>(face * kBands + band)].push_back({index, part});
      }
    }
  }

  void draw(const Patch<Dim>& patch, int face, const typename DepthImage<Dim>::Rectangle& area) const {
    const Occluder<Dim> occluder(patch, origin_);
    Sieve<Dim> sieve(occluder, widening(occluder.center.norm() + occluder.radius));
    const int top = (Dim - 2) * area.low[0], bottom = (Dim - 2) * (area.high[0] - 1);  // In the plane a face is one row.
    const int left = area.low[Dim - 2], length = area.high[Dim - 2] - left;
    for (int row = top; row <= bottom; ++row) {
      const std::size_t first =
          image_.pixels_per_face() * static_cast<std::size_t>(face) + static_cast<std::size_t>(row * image_.resolution() + left);
      const PixelRun<Dim> run = image_.run(first);
      sieve.start(run);
      float* const ranges = &image_[first];
      for (int at = 0; at < length; at += kLanes)
        for (unsigned mask = sieve.pixels(at, ranges + at, std::min(kLanes, length - at)); mask != 0; mask &= mask - 1) {
          const int k = at + std::countr_zero(mask);
          lower(ranges[k], run.direction(k), occluder);
        }
    }
  }

 private:
  [[nodiscard]] double widening(double range) const { return margin_ + range * slope_; }
  void lower(float& least, const Vec<Dim>& direction, const Occluder<Dim>& occluder) const {
    const double range = occluder.range(direction, widening(std::max(0.0, occluder.center.dot(direction))));
    if (range < static_cast<double>(least)) least = static_cast<float>(range);
  }
  [[nodiscard]] static double farthest(const Box<Dim>& box) { return box.center().norm() + 0.5 * box.size().norm(); }

  DepthImage<Dim>& image_;
  const DepthPyramid<Dim> before_;  // Only asked before anything is drawn.
  const Vec<Dim>& origin_;
  double margin_, slope_;
};

}  // namespace

template <int Dim>
void draw_patches(DepthImage<Dim>& image, std::span<const Patch<Dim>> patches, const Vec<Dim>& origin, double margin, double cone_angle) {
  const auto [s, c] = sin_cos(0.5 * cone_angle);
  const PatchDrawer<Dim> drawer(image, origin, margin, s / c);
  using Lists = typename PatchDrawer<Dim>::Lists;
  constexpr std::size_t kChunk = std::size_t{1} << 13;
  std::vector<Lists> parts((patches.size() + kChunk - 1) / kChunk, PatchDrawer<Dim>::empty_lists());
  parallel_chunks(patches.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) drawer.sort_in(parts[begin / kChunk], patches[i], static_cast<std::uint32_t>(i));
  });
  parallel_for(static_cast<std::size_t>(2 * Dim * kBands), 1, [&](std::size_t task) {
    for (const Lists& part : parts)
      for (const Entry<Dim>& entry : part[task]) drawer.draw(patches[entry.patch], static_cast<int>(task) / kBands, entry.area);
  });
}

template void draw_patches<2>(DepthImage<2>&, std::span<const Patch<2>>, const Vec<2>&, double, double);
template void draw_patches<3>(DepthImage<3>&, std::span<const Patch<3>>, const Vec<3>&, double, double);

}  // namespace vantage
