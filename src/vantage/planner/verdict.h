// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/field/belief_view.h"
#include "vantage/planner/glimpses.h"
#include "vantage/planner/last_look.h"

namespace vantage {

/// Why a run ends.
enum class StopReason {
  none,              ///< It does not yet.
  nothing_can_open,  ///< No reachable place is expected to show anything new.
  below_threshold,   ///< The best place would show too little, twice in a row.
  idle,              ///< Many picks in a row gained nothing.
  unreachable,       ///< Unseen space remains, but there is no place left to scan from.
};

/// A region that stays unseen, and why.
template <int Dim>
struct UnseenRegion {
  double volume = 0.0;    ///< [m^Dim]
  double may_open = 0.0;  ///< Expected to be seen from somewhere [m^Dim].
  Box<Dim> box;           ///< [m]
  std::string reason;     ///< "enclosed", "no reachable view", "beyond range", "below the threshold", "too fine for the lattice", "not looked at yet"
  std::optional<Vec<Dim>> open_from;  ///< A reachable place from which it may open, if there is one [m].
};

/// Why the run ended, and what is left.
template <int Dim>
struct Verdict {
  bool complete = false;
  StopReason end = StopReason::none;
  std::string reason;                      ///< One sentence.
  double seen_fraction = 0.0;              ///< seen / (seen + what may still open) [1]
  double seen_low = 0.0, seen_high = 1.0;  ///< Bounds on it [1].
  double unseen_volume = 0.0;              ///< All of it [m^Dim].
  std::vector<UnseenRegion<Dim>> unseen;   ///< Largest first; the smallest are left out.
};

template <int Dim>
struct AssessOptions {
  double opacity = 0.0;                 ///< measured_opacity times its factor [1/m].
  double max_range = 80.0;              ///< Of the sensor [m].
  double least_volume = 0.0;            ///< Smaller regions are not listed [m^Dim].
  const LastLook* last_look = nullptr;  ///< Of the same faces, if they were looked for.
  const LastLook* squeezed = nullptr;   ///< The same from squeezed_nodes().
  const Glimpses<Dim>* glimpsed = nullptr;
};

/// How many nodes are seen.
template <int Dim>
[[nodiscard]] std::size_t seen_nodes(const BeliefView<Dim>& view);

/// What is left to see: shares and regions; `complete` and `reason` of the whole are the caller's.
template <int Dim>
[[nodiscard]] Verdict<Dim> assess(const BeliefView<Dim>& view, std::span<const BoundaryFace<Dim>> faces, const Field<Dim, std::uint8_t>& reachable,
                                  const AssessOptions<Dim>& options);

}  // namespace vantage
