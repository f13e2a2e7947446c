// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "vantage/surface/fit.h"

namespace vantage {

/// Splits sites (in Morton order) into two clusters, each near a piece of a plane of its own; `axis` of the frame gives the first cut. nullopt
/// if that leads nowhere: a cluster runs empty, or a sample of the points already lies off both pieces. Deterministic in the multiset of sites.
template <int Dim>
[[nodiscard]] std::optional<std::array<std::vector<Site<Dim>>, 2>> two_clusters(std::span<const Site<Dim>> sites, const Cell<Dim>& cell,
                                                                                const FitRules<Dim>& rules, const Frame<Dim>& frame, int axis);

}  // namespace vantage
