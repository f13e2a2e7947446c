// SPDX-License-Identifier: Apache-2.0
#include "vantage/surface/surface.h"

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/surface/nearest.h"
#include "vantage/surface/tree.h"

namespace vantage {
namespace {

/// A bound rounded up to float must not pass eta.
constexpr double kFloatMargin = 1e-6;

template <int Dim>
FitRules<Dim> make_rules(const Box<Dim>& domain, const SurfaceOptions& options) {
  check_options(options, "surface");
  FitRules<Dim> rules{Snap<Dim>(domain), 0.0, options.min_points > 0 ? options.min_points : Dim + 2, options.paper};
  rules.limit = options.eta * (1.0 - kFloatMargin) - rules.snap.slack();
  require(rules.limit > 16.0 * rules.snap.slack(), "surface.eta = " + std::to_string(options.eta) + ": too fine for a domain this large; must be > " +
                                                       std::to_string(20.0 * rules.snap.slack()) + " [m]");
  return rules;
}

}  // namespace

void describe(SurfaceOptions& options, const OptionVisitor& visit) {
  visit("eta", options.eta, "m", {1e-6, 1e3}, "Hausdorff tolerance of a fit");
  visit("min_points", options.min_points, "points", {0, 1e6}, "fewest points in a fitted cell; 0 means dimension + 2, the paper's five in 3D");
  visit("max_depth", options.max_depth, "levels", {0, 24}, "deepest cell; the root has depth 0");
  visit("paper", options.paper, "the paper's own behaviour: small cells dropped, best fit kept at the depth limit");
}

template <int Dim>
  requires SpatialDim<Dim>
struct HausdorffTree<Dim>::Impl {
  SurfaceOptions options;
  Tree<Dim> tree;
  std::int64_t outside = 0, not_finite = 0;

  Impl(const Box<Dim>& domain, const SurfaceOptions& given)
      : options(given), tree(make_rules(domain, given), given.eta, static_cast<int>(given.max_depth)) {}

  /// Sorted sites of the points inside; counts the others `sign` times.
  std::vector<Site<Dim>> snapped(std::span<const Vec<Dim>> points, int sign) {
    std::vector<Site<Dim>> sites;
    sites.reserve(points.size());
    std::int64_t infinite = 0, beyond = 0;
    for (const Vec<Dim>& p : points) {
      if (!p.allFinite()) {
        ++infinite;
      } else if (const auto site = tree.rules().snap.site(p)) {
        sites.push_back(*site);
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
      if (box != nullptr && !options.paper) out.back().data_to_surface = out.back().surface_to_data = static_cast<float>(options.eta);
    };
    if (node.inner)
      for (int c = 0; c < Cell<Dim>::kChildren; ++c) collect(node.inner->children[c], cell.child(c), box, out);
    if (node.leaf) {
      for (const Patch<Dim>& patch : node.leaf->fit.patches) take(patch);
      for (const std::uint32_t i : node.leaf->fit.loose) take(loose_patch<Dim>(node.leaf->sites[i], rules));
    }
  }

  /// How far patches may stick out of their cell: no place of theirs is farther than the limit from its data, or in paper mode than the cell is wide.
  [[nodiscard]] double overhang(const Cell<Dim>& cell) const {
    return options.paper ? cell.box(tree.rules().snap.step()).size().norm() : options.eta;
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
SurfaceUpdate<Dim> HausdorffTree<Dim>::insert(std::span<const Vec<Dim>> points) {
  const auto sites = impl_->snapped(points, 1);
  return {static_cast<std::int64_t>(sites.size()), impl_->tree.insert(sites).changed};
}

template <int Dim>
  requires SpatialDim<Dim>
SurfaceUpdate<Dim> HausdorffTree<Dim>::remove(std::span<const Vec<Dim>> points) {
  const auto sites = impl_->snapped(points, -1);
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
  impl_->tree.sharpen();
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
  out.data_to_surface = totals.data_to_surface;
  out.surface_to_data = totals.surface_to_data;
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
