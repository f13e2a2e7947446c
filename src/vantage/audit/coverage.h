// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/audit/reference.h"

namespace vantage {

/// How an explored map compares with the truth.
struct Coverage {
  double fraction = 0.0;      ///< Of the reference set that is called seen [1].
  double widely = 0.0;        ///< The same without what shows only through something as narrow as the spacing; 1 if there is nothing else [1].
  double falsely_free = 0.0;  ///< Called seen although no reachable place sees it: inside an obstacle or shut in [m^Dim].
};

/// `explored` has the spacing h. A reference node counts as seen when the nearest node of the run's lattice is called seen; of several equally
/// near the first that is farther than h from surfaces decides, since beside a surface no visibility calls a node seen. Throws bad_input for
/// another spacing.
template <int Dim>
[[nodiscard]] Coverage coverage(const Reference<Dim>& reference, const Field<Dim, NodeState>& explored);

/// Part of the reference volume that the true line of sight of one of the scans reaches and that is not called seen, told from at most `nodes` of
/// its nodes [m^Dim].
template <int Dim>
[[nodiscard]] double falsely_hidden(const Reference<Dim>& reference, const RayCaster<Dim>& truth, const Field<Dim, NodeState>& explored,
                                    std::span<const Vec<Dim>> scans, std::size_t nodes = 20000);

}  // namespace vantage
