// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vantage/audit/oracle.h"

namespace vantage {

/// How few scans could do: what stands between a greedy oracle and the best one.
struct FewestScans {
  std::int64_t at_least = 0;        ///< With fewer scans nobody who begins at the start and scans from the candidates sees the share.
  double relaxation = 0.0;          ///< The bound by duality alone, before it was rounded up; 1 where it was not needed.
  std::vector<std::size_t> places;  ///< Candidates of the smallest choice found, the start first, that which shows most next.

  [[nodiscard]] bool proven() const { return static_cast<std::int64_t>(places.size()) == at_least; }
};

/// Set cover from the table's candidates, the start among them, until `share` of the targets is seen. `greedy` is a run on this table; nullopt if it
/// never gets there. About `work` elementary steps, see fewest_cover(): the result depends on the arguments alone.
template <int Dim>
[[nodiscard]] std::optional<FewestScans> fewest_scans(const SightTable<Dim>& table, const OracleRun& greedy, double share, std::int64_t work);

}  // namespace vantage
