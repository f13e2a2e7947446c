// SPDX-License-Identifier: Apache-2.0
#include "vantage/visibility/visibility.h"

#include <algorithm>
#include <cmath>

#include "vantage/base/error.h"
#include "vantage/base/parallel.h"
#include "vantage/field/distance.h"
#include "vantage/visibility/seen_from.h"

namespace vantage {
namespace {

/// Pixels fine enough for half a ray step and for half a cell at the farthest node.
template <int Dim>
int resolution_for(const Scan<Dim>& scan, const Grid<Dim>& window) {
  double reach = 0.0;
  const Box<Dim> box = window.bounds();
  for (int corner = 0; corner < (1 << Dim); ++corner) {
    Vec<Dim> p;
    for (int a = 0; a < Dim; ++a) p[a] = (corner >> a & 1) != 0 ? box.high[a] : box.low[a];
    reach = std::max(reach, (p - scan.origin).norm());
  }
  reach = std::max(window.spacing, std::min(reach, scan.pattern.max_range));
  const double pixel = std::min(0.5 * scan.pattern.step, 0.5 * window.spacing / reach);
  return static_cast<int>(std::clamp(std::ceil(2.0 / pixel), 64.0, 1024.0));
}

}  // namespace

void describe(VisibilityOptions& o, const OptionVisitor& visit) {
  visit("range_image", o.range_image, "the scan's own ranges hide what lies behind them");
  visit("patches", o.patches, "the known surface, widened by eta, hides too");
  visit.angle("cone_deg", o.cone_angle, Range{0.0, 20.0}, "full opening of the cone that replaces a ray against patches; the paper's is 1");
}

template <int Dim>
  requires SpatialDim<Dim>
DepthImage<Dim> depth_image(std::span<const Patch<Dim>> patches, const Scan<Dim>& scan, const Grid<Dim>& window, double eta,
                            const VisibilityOptions& options) {
  check_options(options, "visibility");
  DepthImage<Dim> image(resolution_for(scan, window), static_cast<float>(scan.pattern.max_range));
  if (options.range_image) draw_ranges(image, scan);
  if (options.patches) draw_patches<Dim>(image, patches, scan.origin, eta, options.cone_angle);
  return image;
}

template <int Dim>
  requires SpatialDim<Dim>
SeenSet<Dim> seen_by(std::span<const Patch<Dim>> patches, const Scan<Dim>& scan, const Grid<Dim>& window, double eta,
                     const VisibilityOptions& options) {
  return seen_from(depth_image(patches, scan, window, eta, options), Viewpoint<Dim>{scan.origin, scan.pattern.max_range}, window);
}

template <int Dim>
  requires SpatialDim<Dim>
Field<Dim> visibility(std::span<const Patch<Dim>> patches, const Scan<Dim>& scan, const Grid<Dim>& window, double eta,
                      const VisibilityOptions& options) {
  require_memory(static_cast<double>(window.size()), 16.0, "visibility: the lattice");
  const SeenSet<Dim> set = seen_by(patches, scan, window, eta, options);
  Field<Dim> phi = distance_to_patches(patches, window);
  const auto tolerance = static_cast<float>(eta);
  parallel_for(set.blocks().size(), 64, [&](std::size_t block) {
    set.for_rows(block, [&](std::size_t begin, int count, unsigned seen) {
      float* const row = &phi[begin];
      for (int k = 0; k < count; ++k) {
        const float depth = std::max(row[k] - tolerance, std::numeric_limits<float>::min());
        row[k] = (seen >> k & 1U) != 0 ? depth : -depth;
      }
    });
  });
  return phi;
}

#define VANTAGE_INSTANTIATE(D)                                                                                                        \
  template DepthImage<D> depth_image<D>(std::span<const Patch<D>>, const Scan<D>&, const Grid<D>&, double, const VisibilityOptions&); \
  template SeenSet<D> seen_by<D>(std::span<const Patch<D>>, const Scan<D>&, const Grid<D>&, double, const VisibilityOptions&);        \
  template Field<D> visibility<D>(std::span<const Patch<D>>, const Scan<D>&, const Grid<D>&, double, const VisibilityOptions&);
VANTAGE_INSTANTIATE(2)
VANTAGE_INSTANTIATE(3)

}  // namespace vantage
