// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "vantage/surface/cell_fit.h"
#include "vantage/surface/flat.h"

namespace vantage {

/// A cell of so many sites at most is a leaf, whatever it takes (but not in paper mode).
inline constexpr std::size_t kFewSites = 64;

/// In a cell of so many sites what was found out outlasts updates, since it costs more to find it out again.
inline constexpr std::size_t kManySites = 256;

/// The node rule: the patches of a leaf, or nullopt: split the cell. A pure function of the multiset of sites; `moments` are theirs if known. Large
/// cells that fail mostly do so without all their sites being read, if the moments are known. `refusal`, if given, tells why one plane failed.
template <int Dim>
[[nodiscard]] std::optional<CellFit<Dim>> fit_cell(GatheredSites<Dim>& sites, const Moments<Dim>* moments, const Cell<Dim>& cell,
                                                   const FitRules<Dim>& rules, Refusal<Dim>* refusal = nullptr);

/// fit_cell for few sites of which some had a fit before: `numbers` tells each site's number then, or kNewSite. What hangs together with no new site
/// keeps its patches; the result is fit_cell's.
template <int Dim>
[[nodiscard]] CellFit<Dim> refit_few(std::span<const Site<Dim>> sites, std::span<const std::uint32_t> numbers, const CellFit<Dim>& before,
                                     const Cell<Dim>& cell, const FitRules<Dim>& rules);
inline constexpr std::uint32_t kNewSite = ~std::uint32_t{0};

/// At the depth limit: the flat through the sites for those it carries within the limit; the others are loose. In paper mode the best
/// fit, whatever its error.
template <int Dim>
[[nodiscard]] CellFit<Dim> fit_at_limit(std::span<const Site<Dim>> sites, const Cell<Dim>& cell, const FitRules<Dim>& rules);

}  // namespace vantage
