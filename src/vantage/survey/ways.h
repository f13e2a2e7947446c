// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/audit/reference.h"
#include "vantage/survey/survey_options.h"

namespace vantage {

/// Where the scanner can be, and where its tour begins.
template <int Dim>
  requires SpatialDim<Dim>
struct Ways {
  Field<Dim, std::uint8_t> nodes;  ///< Non-zero where it can.
  Vec<Dim> start;                  ///< [m]
};

/// All reachable nodes, or with a height those that are so high above what is below them, up to one spacing, and joined to the one nearest below
/// the start by steps among such nodes: where a person walks with a tripod. Throws bad_input if there is no such node.
template <int Dim>
[[nodiscard]] Ways<Dim> find_ways(const RayCaster<Dim>& truth, const Reference<Dim>& reference, const Vec<Dim>& start, const SurveyOptions& options);

/// Whether p is `height` above what is below it, up to `slack`; always if no height is asked for.
template <int Dim>
[[nodiscard]] bool is_high(const RayCaster<Dim>& truth, const Vec<Dim>& p, double height, double slack);

/// Throws bad_input, naming the height, unless `holds`.
void require_height(bool holds, const SurveyOptions& options);

}  // namespace vantage
