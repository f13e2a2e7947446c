// SPDX-License-Identifier: Apache-2.0
#include "vantage/exchange/publisher.h"

#include <algorithm>

#include "vantage/base/error.h"
#include "vantage/exchange/select.h"

namespace vantage {
namespace {

/// The sites reach a little less far than the tolerance, so that rounding at the rim of the lattice fits between the two.
constexpr double kReach = 1.0 - 2e-5;

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
struct Publisher<Dim>::Impl {
  Delta next;  ///< Number and what all deltas have in common.
  Published<Dim> published;
};

template <int Dim>
  requires SpatialDim<Dim>
Publisher<Dim>::Publisher(std::string source, double tolerance) {
  const auto lattice = ExchangeLattice<Dim>::covering(kReach * kReach * tolerance);
  Delta first;
  first.dim = Dim;
  first.source = std::move(source);
  first.tolerance = tolerance;
  first.spacing = lattice.spacing;
  static_cast<void>(delta_bytes(first));  // Throws if such a delta cannot be.
  impl_ = std::make_unique<Impl>(Impl{first, Published<Dim>(lattice, kReach * tolerance)});
}
template <int Dim>
  requires SpatialDim<Dim>
Publisher<Dim>::~Publisher() = default;
template <int Dim>
  requires SpatialDim<Dim>
Publisher<Dim>::Publisher(Publisher&&) noexcept = default;
template <int Dim>
  requires SpatialDim<Dim>
Publisher<Dim>& Publisher<Dim>::operator=(Publisher&&) noexcept = default;

template <int Dim>
  requires SpatialDim<Dim>
Delta Publisher<Dim>::publish(std::span<const Vec<Dim>> points) {
  const CloudCells<Dim> cloud(impl_->published.lattice(), points);
  const Novelty<Dim> novelty = select_leaves(cloud, impl_->published);
  Delta delta = impl_->next;
  delta.data_to_surface = novelty.data_to_surface;
  delta.surface_to_data = novelty.surface_to_data;
  delta.points = cloud.points().size();
  delta.new_points = novelty.new_points;
  for (const Vec<Dim>& p : cloud.points()) {
    Vec<3> padded = Vec<3>::Zero();
    padded.template head<Dim>() = p;
    delta.bounds.extend(padded);
  }
  delta.counts = {novelty.leaves.planes.size(), novelty.leaves.sites.size()};
  delta.code = encode_leaves(novelty.leaves);
  ++impl_->next.number;
  return delta;
}

template <int Dim>
  requires SpatialDim<Dim>
void Publisher<Dim>::resume(const ExchangeMap& map) {
  for (const ExchangeMap::Entry& entry : map.entries()) {
    const Delta& delta = entry.delta;
    if (delta.source != impl_->next.source || delta.tolerance != impl_->next.tolerance || delta.spacing != impl_->next.spacing) continue;
    impl_->published.add(decoded<Dim>(delta, delta.source));
    impl_->next.number = std::max(impl_->next.number, delta.number + 1);
  }
}

template class Publisher<2>;
template class Publisher<3>;

}  // namespace vantage
