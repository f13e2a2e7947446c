// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/surface.h"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/surface/nearest.h"
#include "vantage/surface/spacing.h"
#include "vantage/surface/tree.h"
#include "vantage/surface/whole.h"

namespace vantage {
namespace {

/// A bound rounded up to float must not pass eta.
constexpr double kFloatMargin = 1e-6;

template <int Dim>
FitRules<Dim> make_rules(const Box<Dim>& domain, const SurfaceOptions& options, const SensorSpacing<Dim>& spacing) {
  check_options(options, "surface");
  require(options.quantise < options.eta, fmt::format("surface.quantise = {}: must be below surface.eta = {} [m]", options.quantise, options.eta));
  require(options.quantise == 0.0 || options.spacing == SurfaceOptions::Spacing::fixed,
          "surface.quantise: not together with surface.spacing = sensor");
  require(!options.paper || options.spacing == SurfaceOptions::Spacing::fixed, "surface.paper: not together with surface.spacing = sensor");
  FitRules<Dim> rules{Snap<Dim>(domain, options.quantise), 0.0, options.min_points > 0 ? options.min_points : Dim + 2, options.paper};
  rules.limit = options.eta * (1.0 - kFloatMargin) - rules.snap.slack();
  const double rounding = Snap<Dim>(domain).slack();
  require(rules.limit > 16.0 * rounding,
          fmt::format("surface.eta = {:g}: too fine for a domain this large; must be > {:g} [m]", options.eta, 20.0 * rounding));
  if (options.spacing == SurfaceOptions::Spacing::sensor) rules.spacing = &spacing;
  return rules;
}

}  // namespace

void describe(SurfaceOptions& options, const OptionVisitor& visit) {
  visit("eta", options.eta, "m", {1e-6, 1e3}, "Hausdorff tolerance of a fit");
  visit("min_points", options.min_points, "points", {0, 1e6}, "fewest points in a fitted cell; 0 means dimension + 2, the paper's five in 3D");
  visit("max_depth", options.max_depth, "levels", {0, 24}, "deepest cell; the root has depth 0");
  visit("spacing", options.spacing, {"fixed", "sensor"},
        "how far a place of a patch may be from the points: eta, or as far as the rays of its scans are apart, if that is more");
  visit("spacing_factor", options.spacing_factor, "", {0.1, 10.0}, "spacing = sensor: times range * step / cos(incidence)");
  visit("spacing_most", options.spacing_most, "m", {0.0, 100.0}, "spacing = sensor: never farther than this");
  visit("quantise", options.quantise, "m", {0.0, 1e3},
        "points count as the centre of their cell of this side, which bounds the memory; 0: as themselves");
  visit("paper", options.paper, "the paper's own behaviour: small cells dropped, best fit kept at the depth limit");
}

template <int Dim>
  requires SpatialDim<Dim>
struct HausdorffTree<Dim>::Impl {
  SurfaceOptions options;
  SensorSpacing<Dim> spacing;
  Tree<Dim> tree;
  std::int64_t outside = 0, not_finite = 0;

  Impl(const Box<Dim>& domain, const SurfaceOptions& given)
      : options(given),
        spacing(given.spacing_factor, given.spacing_most),
        tree(make_rules(domain, given, spacing), given.eta, static_cast<int>(given.max_depth)) {}

  /// Sorted sites of the points inside; counts the others `sign` times.
  std::vector<Site<Dim>> snapped(std::span<const Vec<Dim>> points, const std::optional<SurfaceSensor<Dim>>& sensor, int sign) {
    std::uint32_t scan = 0;
    if (options.spacing == SurfaceOptions::Spacing::sensor) {
      require(sensor.has_value(),
              "surface.spacing = sensor: the points' scanner is not known; scan logs and run folders know it, point clouds do not");
      scan = spacing.number({sensor->position - tree.rules().snap.cube().low, sensor->step});
    }
    std::vector<Site<Dim>> sites;
    sites.reserve(points.size());
    std::int64_t infinite = 0, beyond = 0;
    for (const Vec<Dim>& p : points) {
      if (!p.allFinite()) {
        ++infinite;
      } else if (const auto site = tree.rules().snap.site(p)) {
        sites.push_back(*site);
        sites.back()[Dim] += scan << kCountBits;
      } else {
        ++beyond;
      }
    }
    not_finite = std::max<std::int64_t>(0, not_finite + sign * infinite);
    outside = std::max<std::int64_t>(0, outside + sign * beyond);
    sort_sites<Dim>(sites);
    return sites;
  }

  /// Appends the patches below `node` in Morton order, those that meet `box` if given.
  void collect(const Node<Dim>& node, const Cell<Dim>& cell, const Box<Dim>* box, std::vector<Patch<Dim>>& out) const {
    const FitRules<Dim>& rules = tree.rules();
    if (box != nullptr && (node.inner || node.leaf)) {
      Box<Dim> reach = cell.box(rules.snap.step());
      reach = Box<Dim>{rules.snap.world(reach.low), rules.snap.world(reach.high)}.grown(overhang(cell));
      if (reach.intersection(*box).empty()) return;
    }
    const auto take = [&](const Patch<Dim>& patch) {
      if (box != nullptr && patch.bounds().intersection(*box).empty()) return;
      out.push_back(patch);
      if (box != nullptr && !options.paper) {
        out.back().data_to_surface = static_cast<float>(options.eta);
        out.back().surface_to_data = static_cast<float>(overhang(cell));
      }
    };
    if (node.inner)
      for (int c = 0; c < Cell<Dim>::kChildren; ++c) collect(node.inner->children[c], cell.child(c), box, out);
    if (node.leaf) {
      for (std::size_t i = 0; i < node.leaf->fit.patches.size(); ++i) {
        Patch<Dim> patch = node.leaf->fit.patches[i];
        if (box == nullptr) {
          patch.data_to_surface = node.leaf->sharp[i].data_to_surface;
          patch.surface_to_data = node.leaf->sharp[i].surface_to_data;
        }
        take(patch);
      }
      for (const std::uint32_t i : node.leaf->fit.loose) take(loose_patch<Dim>(node.leaf->sites[i], rules));
    }
  }

  /// How far patches may stick out of their cell: no place of theirs is farther than the limit from its data, or in paper mode than the cell is wide.
  [[nodiscard]] double overhang(const Cell<Dim>& cell) const {
    if (options.paper) return cell.box(tree.rules().snap.step()).size().norm();
    return options.spacing == SurfaceOptions::Spacing::sensor ? std::max(options.eta, options.spacing_most) : options.eta;
  }
};

template <int Dim>
  requires SpatialDim<Dim>
HausdorffTree<Dim>::HausdorffTree(const Box<Dim>& domain, const SurfaceOptions& options) : impl_(std::make_unique<Impl>(domain, options)) {}
template <int Dim>
  requires SpatialDim<Dim>
HausdorffTree<Dim>::~HausdorffTree() = default;
template <int Dim>
  requires SpatialDim<Dim>
HausdorffTree<Dim>::HausdorffTree(HausdorffTree&&) noexcept = default;
template <int Dim>
  requires SpatialDim<Dim>
HausdorffTree<Dim>& HausdorffTree<Dim>::operator=(HausdorffTree&&) noexcept = default;

template <int Dim>
  requires SpatialDim<Dim>
SurfaceUpdate<Dim> HausdorffTree<Dim>::insert(std::span<const Vec<Dim>> points, const std::optional<SurfaceSensor<Dim>>& sensor) {
  const auto sites = impl_->snapped(points, sensor, 1);
  const std::int64_t before = impl_->tree.totals().points;
  const Box<Dim> changed = impl_->tree.insert(sites).changed;
  return {impl_->tree.totals().points - before, changed};
}

template <int Dim>
  requires SpatialDim<Dim>
SurfaceUpdate<Dim> HausdorffTree<Dim>::remove(std::span<const Vec<Dim>> points, const std::optional<SurfaceSensor<Dim>>& sensor) {
  const auto sites = impl_->snapped(points, sensor, -1);
  const std::int64_t before = impl_->tree.totals().points;
  const Box<Dim> changed = impl_->tree.remove(sites).changed;
  return {before - impl_->tree.totals().points, changed};
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<Patch<Dim>> HausdorffTree<Dim>::patches() const {
  std::vector<Patch<Dim>> out;
  impl_->tree.sharpen();
  const Totals totals = impl_->tree.totals();
  out.reserve(static_cast<std::size_t>(totals.fits + totals.segments + totals.loose));
  impl_->collect(impl_->tree.root(), {}, nullptr, out);
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
std::vector<Patch<Dim>> HausdorffTree<Dim>::patches(const Box<Dim>& box) const {
  std::vector<Patch<Dim>> out;
  impl_->collect(impl_->tree.root(), {}, &box, out);
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
SurfaceStatistics HausdorffTree<Dim>::statistics() const {
  const Totals totals = impl_->tree.totals();
  SurfaceStatistics out;
  out.points = totals.points;
  out.outside = impl_->outside;
  out.not_finite = impl_->not_finite;
  out.depth = totals.depth;
  out.nodes = totals.nodes;
  out.leaves = totals.leaves;
  out.fits = totals.fits;
  out.segments = totals.segments;
  out.loose_points = totals.loose;
  out.eta = impl_->options.eta;
  out.quantise = impl_->options.quantise;
  out.beyond_eta = totals.beyond_eta;
  const auto bounds = whole_errors(impl_->tree);
  out.data_to_surface = bounds.data_to_surface;
  out.surface_to_data = bounds.surface_to_data;
  if (impl_->options.paper) out.data_to_surface = farthest_site(impl_->tree);
  return out;
}

template <int Dim>
  requires SpatialDim<Dim>
const SurfaceOptions& HausdorffTree<Dim>::options() const {
  return impl_->options;
}

template class HausdorffTree<2>;
template class HausdorffTree<3>;

}  // namespace vantage
